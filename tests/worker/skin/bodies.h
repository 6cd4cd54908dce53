// SPDX-License-Identifier: GPL-3.0-or-later
// Closed outward bodies with known volumes, for the tests of skin, frame and export.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>

#include "worker/mesh/triangle_mesh.h"

namespace skinframe::bodies {

inline TriangleMesh as_stored(TriangleMesh mesh) {
  for (auto& v : mesh.vertices) v = v.cast<float>().cast<double>();
  return mesh;
}

// Unit cells of `size_mm`, their outer faces; cells must not touch along an edge alone.
inline TriangleMesh blocks(const Eigen::Vector3i& cells, const Eigen::Vector3d& size_mm,
                           const std::function<bool(int, int, int)>& filled) {
  TriangleMesh mesh;
  std::map<std::array<int, 3>, int> index;
  const auto vertex = [&](const Eigen::Vector3i& p) {
    const auto [it, fresh] = index.try_emplace({p.x(), p.y(), p.z()}, static_cast<int>(mesh.vertices.size()));
    if (fresh) mesh.vertices.push_back(p.cast<double>().cwiseProduct(size_mm));
    return it->second;
  };
  const auto solid = [&](const Eigen::Vector3i& p) {
    return (p.array() >= 0).all() && (p.array() < cells.array()).all() && filled(p.x(), p.y(), p.z());
  };
  for (int x = 0; x < cells.x(); ++x) {
    for (int y = 0; y < cells.y(); ++y) {
      for (int z = 0; z < cells.z(); ++z) {
        const Eigen::Vector3i p(x, y, z);
        if (!solid(p)) continue;
        for (int axis = 0; axis < 3; ++axis) {
          for (int side = 0; side < 2; ++side) {
            const Eigen::Vector3i out = Eigen::Vector3i::Unit(axis);
            if (solid(side == 1 ? Eigen::Vector3i(p + out) : Eigen::Vector3i(p - out))) continue;
            const Eigen::Vector3i u = Eigen::Vector3i::Unit((axis + 1) % 3),
                                  v = Eigen::Vector3i::Unit((axis + 2) % 3);
            const Eigen::Vector3i o = p + side * out;
            std::array<int, 4> q{vertex(o), vertex(o + u), vertex(o + u + v), vertex(o + v)};
            if (side == 0) std::swap(q[1], q[3]);
            mesh.triangles.push_back({q[0], q[1], q[2]});
            mesh.triangles.push_back({q[0], q[2], q[3]});
          }
        }
      }
    }
  }
  return as_stored(mesh);
}

inline TriangleMesh box(double x, double y, double z) {
  return blocks({1, 1, 1}, {x, y, z}, [](int, int, int) { return true; });
}

// A torus about the z axis that lies on z = 0: ring radius R, tube radius r.
inline TriangleMesh torus(double ring, double tube, int around = 96, int across = 48) {
  TriangleMesh mesh;
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const double u = 2 * std::numbers::pi * i / around, v = 2 * std::numbers::pi * j / across;
      const double rho = ring + tube * std::cos(v);
      mesh.vertices.emplace_back(rho * std::cos(u), rho * std::sin(u), tube + tube * std::sin(v));
      const int a = i * across + j, b = ((i + 1) % around) * across + j;
      const int c = ((i + 1) % around) * across + (j + 1) % across, d = i * across + (j + 1) % across;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  }
  return as_stored(mesh);
}

// A sphere that touches z = 0: an icosahedron divided `levels` times.
inline TriangleMesh sphere(double radius, int levels = 5) {
  const double g = std::numbers::phi;
  TriangleMesh mesh;
  mesh.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int a, int b) {
      const auto [it, fresh] = middles.try_emplace(std::minmax(a, b), static_cast<int>(mesh.vertices.size()));
      if (fresh) mesh.vertices.push_back(0.5 * (mesh.vertices[a] + mesh.vertices[b]));
      return it->second;
    };
    std::vector<std::array<int, 3>> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const auto& t : {std::array{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}})
        finer.push_back(t);
    }
    mesh.triangles = std::move(finer);
    for (auto& v : mesh.vertices) v.normalize();
  }
  for (auto& v : mesh.vertices) v = radius * (v + Eigen::Vector3d::UnitZ());
  return as_stored(mesh);
}

// V - E + F of a closed mesh, which has 3/2 as many edges as triangles.
inline int euler_characteristic(const TriangleMesh& mesh) {
  return static_cast<int>(mesh.vertices.size()) - static_cast<int>(mesh.triangles.size()) / 2;
}

}  // namespace skinframe::bodies
