// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles of the exported mesh that cut each other. By separating axes: two triangles cut where they
// overlap on every axis that could part them by more than kDepthMm, ten times what the coordinates of a
// binary STL are rounded to. What only touches is not counted.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "worker/check/claims.h"
#include "worker/check/near_boxes.h"

namespace skinframe::check {
namespace {

constexpr double kDepthMm = 2e-4;
constexpr double kFoldCosine = -0.999999;  // of two triangles on one side: one lies on the other
constexpr double kShortAxis = 1e-9;        // of the lengths it was made from: no direction of its own

using Corners = std::array<Eigen::Vector3d, 3>;

Corners corners_of(const TriangleMesh& mesh, int t) {
  const auto& c = mesh.triangles[t];
  return {mesh.vertices[c[0]], mesh.vertices[c[1]], mesh.vertices[c[2]]};
}

// Whether the shadows on the axis overlap by more than kDepthMm.
bool overlap_on(const Eigen::Vector3d& axis, const Corners& a, const Corners& b) {
  const double a0 = axis.dot(a[0] - b[0]), a1 = axis.dot(a[1] - b[0]), a2 = axis.dot(a[2] - b[0]);
  const double b1 = axis.dot(b[1] - b[0]), b2 = axis.dot(b[2] - b[0]);
  const double depth = std::min(std::max({a0, a1, a2}) - std::min({0.0, b1, b2}),
                                std::max({0.0, b1, b2}) - std::min({a0, a1, a2}));
  return depth > kDepthMm * axis.norm();
}

bool cut(const Corners& a, const Corners& b) {
  const Corners u{a[1] - a[0], a[2] - a[1], a[0] - a[2]}, v{b[1] - b[0], b[2] - b[1], b[0] - b[2]};
  const Eigen::Vector3d n = u[0].cross(u[1]), m = v[0].cross(v[1]);
  const auto parts = [&](const Eigen::Vector3d& axis, double scale) {
    return axis.norm() > kShortAxis * scale && !overlap_on(axis, a, b);
  };
  if (parts(n, u[0].norm() * u[1].norm()) || parts(m, v[0].norm() * v[1].norm())) return false;
  for (int i = 0; i < 3; ++i) {
    if (parts(u[i].cross(n), u[i].norm() * n.norm()) || parts(v[i].cross(m), v[i].norm() * m.norm()))
      return false;
    for (int j = 0; j < 3; ++j)
      if (parts(u[i].cross(v[j]), u[i].norm() * v[j].norm())) return false;
  }
  return true;
}

bool fold(const Corners& a, const Corners& b) {
  const Eigen::Vector3d n = (a[1] - a[0]).cross(a[2] - a[0]), m = (b[1] - b[0]).cross(b[2] - b[0]);
  const double lengths = n.norm() * m.norm();
  return lengths > 0.0 && n.dot(m) < kFoldCosine * lengths;
}

}  // namespace

Crossings count_crossings(const TriangleMesh& mesh, std::size_t own) {
  std::vector<Eigen::AlignedBox3d> boxes;
  boxes.reserve(mesh.triangles.size());
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    const Corners p = corners_of(mesh, t);
    boxes.emplace_back(p[0].cwiseMin(p[1]).cwiseMin(p[2]), p[0].cwiseMax(p[1]).cwiseMax(p[2]));
  }
  Crossings crossings;
  for_each_overlap(boxes, [&](int s, int t) {
    int shared = 0;
    for (int v : mesh.triangles[s])
      shared += std::count(mesh.triangles[t].begin(), mesh.triangles[t].end(), v) > 0;
    const Corners a = corners_of(mesh, s), b = corners_of(mesh, t);
    if (shared == 2 ? !fold(a, b) : shared < 2 && !cut(a, b)) return;
    // s < t: where t is M's own, so is s.
    (static_cast<std::size_t>(t) < own ? crossings.own : crossings.added) += 1;
    if (static_cast<std::size_t>(t) >= own && crossings.added == 1) crossings.first_mm = a[0];
  });
  return crossings;
}

void claim_crossings(const ExportedPrinter& result, Verdict* verdict) {
  const Crossings found = count_crossings(*result.merged, result.solid_triangles);
  verdict->claims.push_back(
      {"no self-intersection beyond the input's", found.added == 0 && result.crossings == 0,
       fmt::format(
           "{} pairs of triangles cut each other by more than {:.1g} mm beside {} of the input's own; "
           "reported {}{}",
           found.added, kDepthMm, found.own, result.crossings,
           found.added == 0 ? ""
                            : fmt::format("; the first at ({:.2f}, {:.2f}, {:.2f}) mm", found.first_mm.x(),
                                          found.first_mm.y(), found.first_mm.z()))});
  if (!result.compact) return;
  // The compact mesh's outer triangles are not told apart from the rest: all its pairs together.
  const Crossings compact = count_crossings(*result.compact, 0);
  verdict->claims.push_back(
      {"the compact mesh adds no self-intersection",
       compact.added <= found.own && result.compact_crossings == 0,
       fmt::format("{} pairs of triangles cut each other; {} in the full mesh, {} reported", compact.added,
                   found.own + found.added, result.compact_crossings)});
}

}  // namespace skinframe::check
