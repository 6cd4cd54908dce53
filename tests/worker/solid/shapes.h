// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies of known measures for the tests of this room, and ways to harm them.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "worker/mesh/triangle_mesh.h"

namespace skinframe::testing {

inline TriangleMesh box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    mesh.vertices.emplace_back(i & 1 ? high.x() : low.x(), i & 2 ? high.y() : low.y(),
                               i & 4 ? high.z() : low.z());
  }
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

inline TriangleMesh cube(double edge) { return box({0, 0, 0}, {edge, edge, edge}); }

// A closed strip of `around` x `along` quads on a torus (genus 1), axis z.
inline TriangleMesh torus(double ring_radius, double tube_radius, int around, int along) {
  TriangleMesh mesh;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < along; ++j) {
      const double u = 2 * std::numbers::pi * i / around, v = 2 * std::numbers::pi * j / along;
      const double r = ring_radius + tube_radius * std::cos(v);
      mesh.vertices.emplace_back(r * std::cos(u), r * std::sin(u), tube_radius * std::sin(v));
    }
  }
  const auto at = [&](int i, int j) { return (i % around) * along + j % along; };
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < along; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

// Latitudes and longitudes; two poles.
inline TriangleMesh ball(double radius, int around, int rings) {
  TriangleMesh mesh;
  mesh.vertices.emplace_back(0, 0, radius);
  for (int r = 1; r < rings; ++r) {
    for (int i = 0; i < around; ++i) {
      const double theta = std::numbers::pi * r / rings, phi = 2 * std::numbers::pi * i / around;
      mesh.vertices.emplace_back(radius * Eigen::Vector3d(std::sin(theta) * std::cos(phi),
                                                          std::sin(theta) * std::sin(phi), std::cos(theta)));
    }
  }
  mesh.vertices.emplace_back(0, 0, -radius);
  const int south = static_cast<int>(mesh.vertices.size()) - 1;
  const auto at = [&](int r, int i) { return 1 + (r - 1) * around + i % around; };
  for (int i = 0; i < around; ++i) {
    mesh.triangles.push_back({0, at(1, i), at(1, i + 1)});
    for (int r = 1; r + 1 < rings; ++r) {
      mesh.triangles.push_back({at(r, i), at(r + 1, i), at(r + 1, i + 1)});
      mesh.triangles.push_back({at(r, i), at(r + 1, i + 1), at(r, i + 1)});
    }
    mesh.triangles.push_back({at(rings - 1, i), south, at(rings - 1, i + 1)});
  }
  return mesh;
}

inline TriangleMesh moebius_strip(int around) {
  TriangleMesh mesh;
  for (int i = 0; i < around; ++i) {
    const double u = 2 * std::numbers::pi * i / around;
    for (const double s : {-0.3, 0.3}) {
      const double r = 1 + s * std::cos(u / 2);
      mesh.vertices.emplace_back(r * std::cos(u), r * std::sin(u), s * std::sin(u / 2));
    }
  }
  for (int i = 0; i < around; ++i) {
    const int a = 2 * i, b = 2 * i + 1;
    const bool last = i + 1 == around;  // where the strip meets itself turned over
    const int c = last ? 1 : 2 * i + 2, d = last ? 0 : 2 * i + 3;
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({b, d, c});
  }
  return mesh;
}

inline TriangleMesh merged(TriangleMesh a, const TriangleMesh& b) {
  const int shift = static_cast<int>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const auto& t : b.triangles) a.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  return a;
}

inline TriangleMesh moved(TriangleMesh mesh, const Eigen::Vector3d& by) {
  for (auto& v : mesh.vertices) v += by;
  return mesh;
}

inline TriangleMesh turned_inside_out(TriangleMesh mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

// As an STL holds it: no shared vertices, each corner off by up to `jitter` in each direction.
inline TriangleMesh soup(const TriangleMesh& mesh, double jitter) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> off(-jitter, jitter);
  TriangleMesh torn;
  for (const auto& t : mesh.triangles) {
    const int first = static_cast<int>(torn.vertices.size());
    for (const int v : t)
      torn.vertices.push_back(mesh.vertices[v] + Eigen::Vector3d(off(random), off(random), off(random)));
    torn.triangles.push_back({first, first + 1, first + 2});
  }
  return torn;
}

}  // namespace skinframe::testing
