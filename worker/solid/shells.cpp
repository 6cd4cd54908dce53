// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/solid/shells.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "worker/solid/half_edges.h"

namespace skinframe {
namespace {

void drop_shells(TriangleMesh& mesh, const std::vector<Shell>& shells, const std::vector<char>& dropped) {
  std::vector<char> gone(mesh.triangles.size(), 0);
  for (std::size_t s = 0; s < shells.size(); ++s) {
    if (!dropped[s]) continue;
    for (const int t : shells[s].triangles) gone[t] = 1;
  }
  std::size_t next = 0;
  for (std::size_t t = 0; t < gone.size(); ++t) {
    if (!gone[t]) mesh.triangles[next++] = mesh.triangles[t];
  }
  mesh.triangles.resize(next);
  drop_unused_vertices(mesh);
}

// A sum of angles, each within (-pi, pi], as the argument of a product: an arc tangent an angle would take
// longest.
class AngleSum {
 public:
  // The angle of the complex number x + i y, not 0.
  void add(double x, double y) {
    const double re = re_ * x - im_ * y, im = re_ * y + im_ * x;
    const bool both_up = im_ >= 0 && y >= 0, both_down = im_ < 0 && y < 0;
    if (both_up && (im < 0 || (im == 0 && re_ < 0 && x < 0))) ++turns_;
    if (both_down && im >= 0) --turns_;
    const double size = std::abs(re) + std::abs(im);
    re_ = re / size;
    im_ = im / size;
  }
  double total() const { return 2 * std::numbers::pi * turns_ + std::atan2(im_, re_); }

 private:
  double re_ = 1, im_ = 0;
  int turns_ = 0;
};

// Sum of the solid angles of the shell's triangles over 4 pi (Van Oosterom and Strackee 1983).
bool encloses(const TriangleMesh& mesh, const Shell& shell, const Eigen::Vector3d& point) {
  AngleSum half_angles;
  for (const int t : shell.triangles) {
    const Eigen::Vector3d a = mesh.vertices[mesh.triangles[t][0]] - point;
    const Eigen::Vector3d b = mesh.vertices[mesh.triangles[t][1]] - point;
    const Eigen::Vector3d c = mesh.vertices[mesh.triangles[t][2]] - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    const double x = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb, y = a.dot(b.cross(c));
    if (std::abs(x) + std::abs(y) > 0) half_angles.add(x, y);  // else the point is one of the corners
  }
  return std::abs(half_angles.total()) > std::numbers::pi;  // half of the full 2 pi
}

}  // namespace

std::vector<Shell> find_shells(const TriangleMesh& mesh) {
  const int count = static_cast<int>(mesh.triangles.size());
  DisjointSets sets(mesh.triangles.size());
  std::vector<char> at_boundary(mesh.triangles.size(), 0);
  const EdgeTable edges(mesh);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto h = edges.half_edges(e);
    if (h.size() == 1) at_boundary[triangle_of(h[0])] = 1;
    for (const int other : h) sets.join(triangle_of(h[0]), triangle_of(other));
  }
  std::vector<Shell> shells;
  std::vector<int> shell_of(mesh.triangles.size(), -1);
  for (int t = 0; t < count; ++t) {
    int& number = shell_of[sets.find(t)];
    if (number < 0) {
      number = static_cast<int>(shells.size());
      shells.emplace_back();
    }
    shells[number].triangles.push_back(t);
    if (at_boundary[t]) shells[number].closed = false;
  }
  for (Shell& shell : shells) {
    shell.box.min = shell.box.max = mesh.vertices[mesh.triangles[shell.triangles[0]][0]];
    const Eigen::Vector3d origin = shell.box.min;
    for (const int t : shell.triangles) {
      const auto& [a, b, c] = mesh.triangles[t];
      for (const int v : mesh.triangles[t]) {
        shell.box.min = shell.box.min.cwiseMin(mesh.vertices[v]);
        shell.box.max = shell.box.max.cwiseMax(mesh.vertices[v]);
      }
      shell.volume +=
          (mesh.vertices[a] - origin).dot((mesh.vertices[b] - origin).cross(mesh.vertices[c] - origin)) / 6;
    }
  }
  return shells;
}

// Shells that merely cross each other are left alone, so several points are asked.
bool contains(const TriangleMesh& mesh, const Shell& outer, const Shell& inner) {
  if ((inner.box.min.array() < outer.box.min.array()).any() ||
      (inner.box.max.array() > outer.box.max.array()).any()) {
    return false;
  }
  constexpr std::size_t kAsked = 32;
  const std::size_t step = std::max<std::size_t>(1, inner.triangles.size() / kAsked);
  for (std::size_t i = 0; i < inner.triangles.size(); i += step) {
    if (!encloses(mesh, outer, mesh.vertices[mesh.triangles[inner.triangles[i]][0]])) return false;
  }
  return true;
}

std::size_t drop_small_open_shells(TriangleMesh& mesh, double size) {
  const std::vector<Shell> shells = find_shells(mesh);
  std::vector<char> dropped(shells.size(), 0);
  for (std::size_t s = 0; s < shells.size(); ++s) {
    dropped[s] = !shells[s].closed && shells[s].box.extent().norm() <= size;
  }
  const auto count = static_cast<std::size_t>(std::count(dropped.begin(), dropped.end(), 1));
  if (count > 0) drop_shells(mesh, shells, dropped);
  return count;
}

std::size_t drop_empty_shells(TriangleMesh& mesh, double volume) {
  const std::vector<Shell> shells = find_shells(mesh);
  std::vector<char> dropped(shells.size(), 0);
  for (std::size_t s = 0; s < shells.size(); ++s) {
    dropped[s] = shells[s].closed && std::abs(shells[s].volume) <= volume;
  }
  const auto count = static_cast<std::size_t>(std::count(dropped.begin(), dropped.end(), 1));
  if (count > 0) drop_shells(mesh, shells, dropped);
  return count;
}

Result<NestingCounts> nest_shells(TriangleMesh& mesh, bool trust_file_senses) {
  NestingCounts counts;
  const std::vector<Shell> shells = find_shells(mesh);
  if (shells.size() > kMostShells) {
    return invalid_input(
        fmt::format("the mesh falls into {} unconnected shells, more than the limit of {}; unite its parts",
                    shells.size(), kMostShells));
  }
  std::vector<char> dropped(shells.size(), 0);
  for (std::size_t s = 0; s < shells.size(); ++s) {
    int depth = 0;
    int winding = 0;  // of the space just outside, in the senses of the file
    std::size_t outermost = s;
    for (std::size_t o = 0; o < shells.size(); ++o) {
      if (o == s || !contains(mesh, shells[o], shells[s])) continue;
      ++depth;
      winding += shells[o].volume > 0 ? 1 : -1;
      if (std::abs(shells[o].volume) > std::abs(shells[outermost].volume)) outermost = o;
    }
    bool cavity = depth % 2 == 1;
    if (trust_file_senses) {
      const int sense = shells[outermost].volume > 0 ? 1 : -1;
      const bool filled_outside = winding * sense > 0;
      const bool filled_inside = winding * sense + (shells[s].volume > 0 ? sense : -sense) > 0;
      cavity = filled_outside;
      dropped[s] = filled_outside == filled_inside;
    }
    if (dropped[s]) {
      ++counts.swallowed;
      continue;
    }
    counts.cavities += cavity;
    if ((shells[s].volume < 0) == cavity) continue;
    ++counts.turned;
    for (const int t : shells[s].triangles) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  }
  if (counts.swallowed > 0) drop_shells(mesh, shells, dropped);
  return counts;
}

}  // namespace skinframe
