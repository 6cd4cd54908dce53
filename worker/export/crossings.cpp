// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/export/crossings.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>

#include "worker/export/touching_boxes.h"
#include "worker/export/triangle_gap.h"
#include "worker/skin/box_tree.h"

namespace skinframe {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
// Two on one side that are nearer to folded than this count as lying on each other: slivers are rounded to
// float, and no program that reads them can tell the difference.
constexpr double kFoldCosine = -0.99999;
constexpr double kNoArea = 1e-9;  // of the longest side squared: left to the exact predicates

Kernel::Point_3 point(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

bool has_area(const Corners& p, const Eigen::Vector3d& normal) {
  const double longest =
      std::max({(p[1] - p[0]).squaredNorm(), (p[2] - p[1]).squaredNorm(), (p[0] - p[2]).squaredNorm()});
  return normal.squaredNorm() > kNoArea * kNoArea * longest * longest;
}

// What floating point tells on the safe side: most pairs are apart, or fair neighbours.
bool are_surely_clear(const TriangleMesh& mesh, const std::array<int, 3>& p, const std::array<int, 3>& q) {
  const Corners a{mesh.vertices[p[0]], mesh.vertices[p[1]], mesh.vertices[p[2]]};
  const Corners b{mesh.vertices[q[0]], mesh.vertices[q[1]], mesh.vertices[q[2]]};
  const Eigen::Vector3d n = (a[1] - a[0]).cross(a[2] - a[0]), m = (b[1] - b[0]).cross(b[2] - b[0]);
  if (!has_area(a, n) || !has_area(b, m)) return false;
  int shared = 0, i = 0, j = 0;
  for (int k = 0; k < 3; ++k) {
    for (int l = 0; l < 3; ++l) {
      if (p[k] != q[l]) continue;
      ++shared;
      i = k;
      j = l;
    }
  }
  if (shared == 0) return are_apart(a, b);
  if (shared == 1)
    return meet_in_their_corner_only({a[i], a[(i + 1) % 3], a[(i + 2) % 3]},
                                     {b[j], b[(j + 1) % 3], b[(j + 2) % 3]});
  return shared == 2 && n.dot(m) > 0.0;
}

// Not of unit length.
Eigen::Vector3d normal(const TriangleMesh& mesh, const std::array<int, 3>& c) {
  return (mesh.vertices[c[1]] - mesh.vertices[c[0]]).cross(mesh.vertices[c[2]] - mesh.vertices[c[0]]);
}

bool cross(const TriangleMesh& mesh, int s, int t) {
  const auto &p = mesh.triangles[s], &q = mesh.triangles[t];
  if (are_surely_clear(mesh, p, q)) return false;
  std::array<int, 3> shared{};
  int count = 0;
  for (int v : p)
    if (std::find(q.begin(), q.end(), v) != q.end()) shared[count++] = v;
  const auto at = [&](int v) { return point(mesh.vertices[v]); };
  const Kernel::Triangle_3 a(at(p[0]), at(p[1]), at(p[2])), b(at(q[0]), at(q[1]), at(q[2]));
  if (a.is_degenerate() || b.is_degenerate()) return count < 2;
  if (count == 0) return CGAL::do_intersect(a, b);
  const auto others = [&](const std::array<int, 3>& corners) {
    std::vector<int> rest;
    for (int v : corners)
      if (std::find(shared.begin(), shared.begin() + count, v) == shared.begin() + count) rest.push_back(v);
    return rest;
  };
  const auto u = others(p), w = others(q);
  if (count == 1)  // the side across the shared corner, of either
    return CGAL::do_intersect(Kernel::Segment_3(at(u[0]), at(u[1])), b) ||
           CGAL::do_intersect(Kernel::Segment_3(at(w[0]), at(w[1])), a);
  if (count == 2)
    return normal(mesh, p).dot(normal(mesh, q)) <
           kFoldCosine * normal(mesh, p).norm() * normal(mesh, q).norm();
  return true;  // the same three corners
}

}  // namespace

std::vector<std::pair<int, int>> crossing_triangles(const TriangleMesh& mesh, const std::vector<int>& among) {
  std::vector<Eigen::AlignedBox3f> boxes;
  boxes.reserve(among.size());
  for (const int t : among) {
    Eigen::AlignedBox3d box;
    for (int v : mesh.triangles[t]) box.extend(mesh.vertices[v]);
    boxes.push_back(box_around(box));
  }
  auto found = touching_pairs(boxes, [&](int i, int j) { return cross(mesh, among[i], among[j]); });
  for (auto& [i, j] : found) {
    std::tie(i, j) = std::minmax({among[i], among[j]});
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<std::pair<int, int>> crossing_triangles(const TriangleMesh& mesh) {
  std::vector<int> all(mesh.triangles.size());
  std::iota(all.begin(), all.end(), 0);
  return crossing_triangles(mesh, all);
}

}  // namespace skinframe
