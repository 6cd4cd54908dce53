// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/export/triangle_gap.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace skinframe {
namespace {

constexpr double kParallel = 1e-12;  // squared sine below which two directions give no axis

// The axis parts them when their shadows on it do, by `gap` at least.
bool parts(const Eigen::Vector3d& axis, const Corners& a, const Corners& b, double gap) {
  const double a0 = axis.dot(a[0]), a1 = axis.dot(a[1]), a2 = axis.dot(a[2]);
  const double b0 = axis.dot(b[0]), b1 = axis.dot(b[1]), b2 = axis.dot(b[2]);
  const double between = std::max(std::min({b0, b1, b2}) - std::max({a0, a1, a2}),
                                  std::min({a0, a1, a2}) - std::max({b0, b1, b2}));
  return between > 0.0 && between * between >= gap * gap * axis.squaredNorm();
}

Corners sides_of(const Corners& t) { return {t[1] - t[0], t[2] - t[1], t[0] - t[2]}; }

// Whether the segment from p to q leaves the triangle's plane out, or its inside.
bool segment_misses(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Corners& t) {
  const Eigen::Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]);
  const double length = normal.norm();
  const double margin = kLeastGapMm * length;
  const double above = normal.dot(p - t[0]), below = normal.dot(q - t[0]);
  if ((above > margin && below > margin) || (above < -margin && below < -margin)) return true;
  const auto parted = [&](const Eigen::Vector3d& axis) {
    const double a0 = axis.dot(t[0] - p), a1 = axis.dot(t[1] - p), a2 = axis.dot(t[2] - p);
    const double s1 = axis.dot(q - p), low = std::min(0.0, s1), high = std::max(0.0, s1);
    const double between = std::max(low - std::max({a0, a1, a2}), std::min({a0, a1, a2}) - high);
    return between > 0.0 && between * between >= kLeastGapMm * kLeastGapMm * axis.squaredNorm();
  };
  // Planes upright on the triangle, through one of its sides or the segment: on smooth surfaces one of them
  // does. Then those through a side and along the segment.
  const Corners sides = sides_of(t);
  const Eigen::Vector3d along = q - p;
  if (parted(sides[0].cross(normal)) || parted(sides[2].cross(normal)) || parted(sides[1].cross(normal)) ||
      parted(along.cross(normal)))
    return true;
  return std::any_of(sides.begin(), sides.end(), [&](const Eigen::Vector3d& side) {
    const Eigen::Vector3d axis = along.cross(side);
    return axis.squaredNorm() > kParallel * side.squaredNorm() * along.squaredNorm() && parted(axis);
  });
}

}  // namespace

bool are_apart(const Corners& a, const Corners& b) {
  for (int k = 0; k < 3; ++k) {
    if (std::max({a[0][k], a[1][k], a[2][k]}) < std::min({b[0][k], b[1][k], b[2][k]}) - kLeastGapMm)
      return true;
    if (std::max({b[0][k], b[1][k], b[2][k]}) < std::min({a[0][k], a[1][k], a[2][k]}) - kLeastGapMm)
      return true;
  }
  const Corners u = sides_of(a), v = sides_of(b);
  const Eigen::Vector3d n = u[0].cross(u[1]), m = v[0].cross(v[1]);
  if (parts(n, a, b, kLeastGapMm) || parts(m, a, b, kLeastGapMm)) return true;
  const auto try_axis = [&](const Eigen::Vector3d& axis, double scale) {
    return axis.squaredNorm() > kParallel * scale && parts(axis, a, b, kLeastGapMm);
  };
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (try_axis(u[i].cross(v[j]), u[i].squaredNorm() * v[j].squaredNorm())) return true;
    }
    if (try_axis(u[i].cross(n), u[i].squaredNorm() * n.squaredNorm())) return true;
    if (try_axis(v[i].cross(m), v[i].squaredNorm() * m.squaredNorm())) return true;
  }
  return false;
}

// They meet elsewhere only where the side across the corner, of either, meets the other triangle.
bool meet_in_their_corner_only(const Corners& a, const Corners& b) {
  return segment_misses(a[1], a[2], b) && segment_misses(b[1], b[2], a);
}

}  // namespace skinframe
