// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/export/crossings.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>
#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace skinframe {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Box = CGAL::Box_intersection_d::Box_with_info_d<float, 3, int>;
constexpr std::size_t kPairsABatch = 1 << 16;
// Two on one side that are nearer to folded than this count as lying on each other: slivers are rounded to
// float, and no program that reads them can tell the difference.
constexpr double kFoldCosine = -0.99999;
constexpr double kBoxRounding = 1e-6;  // relative, absolute below 1 mm: more than a turn and a float lose

Kernel::Point_3 point(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

// Not of unit length.
Eigen::Vector3d normal(const TriangleMesh& mesh, const std::array<int, 3>& c) {
  return (mesh.vertices[c[1]] - mesh.vertices[c[0]]).cross(mesh.vertices[c[2]] - mesh.vertices[c[0]]);
}

bool cross(const TriangleMesh& mesh, int s, int t) {
  const auto &p = mesh.triangles[s], &q = mesh.triangles[t];
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
  // CGAL sweeps along one axis what it cannot part along another, so that flat walls square to the axes cost
  // pairs by the square. Seen askew they do not; boxes only propose, a little wider than need be.
  const Eigen::Matrix3d askew = Eigen::AngleAxisd(0.7, Eigen::Vector3d(3, 5, 8).normalized()).matrix();
  std::vector<Box> boxes;
  boxes.reserve(among.size());
  for (const int t : among) {
    Eigen::AlignedBox3d box;
    for (int v : mesh.triangles[t]) box.extend(askew * mesh.vertices[v]);
    float from[3], to[3];
    for (int k = 0; k < 3; ++k) {
      const double room = kBoxRounding * (1.0 + std::max(std::abs(box.min()[k]), std::abs(box.max()[k])));
      from[k] = static_cast<float>(box.min()[k] - room);
      to[k] = static_cast<float>(box.max()[k] + room);
    }
    boxes.emplace_back(from, to, t);
  }
  std::vector<std::pair<int, int>> batch, found;
  const auto judge = [&] {
    std::vector<char> crosses(batch.size(), 0);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, batch.size(), 1024), [&](const auto& range) {
      for (std::size_t i = range.begin(); i < range.end(); ++i)
        crosses[i] = cross(mesh, batch[i].first, batch[i].second);
    });
    for (std::size_t i = 0; i < batch.size(); ++i)
      if (crosses[i]) found.push_back(batch[i]);
    batch.clear();
  };
  const auto are_flat_neighbours = [&](int s, int t) {
    // Two on one side, not folded back: by far the most pairs, and none of them cross.
    const auto &p = mesh.triangles[s], &q = mesh.triangles[t];
    int shared = 0;
    for (int v : p) shared += std::find(q.begin(), q.end(), v) != q.end();
    if (shared != 2) return false;
    return normal(mesh, p).dot(normal(mesh, q)) > 0.0;
  };
  CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const Box& a, const Box& b) {
    if (are_flat_neighbours(a.info(), b.info())) return;
    batch.emplace_back(std::min(a.info(), b.info()), std::max(a.info(), b.info()));
    if (batch.size() == kPairsABatch) judge();
  });
  judge();
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<std::pair<int, int>> crossing_triangles(const TriangleMesh& mesh) {
  std::vector<int> all(mesh.triangles.size());
  std::iota(all.begin(), all.end(), 0);
  return crossing_triangles(mesh, all);
}

}  // namespace skinframe
