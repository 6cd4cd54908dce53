// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/frame/on_m1.h"

#include <algorithm>
#include <cmath>

namespace skinframe {
namespace {

constexpr int kBisections = 20;

}  // namespace

ChordDeviation chord_deviation(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Skin& skin) {
  ChordDeviation worst;
  const int steps = std::clamp(static_cast<int>(std::ceil((b - a).norm() / skin.voxel_mm)), 8, 400);
  for (int i = 1; i < steps; ++i) {
    const double off = skin.field.at(a + (b - a) * (static_cast<double>(i) / steps)) + skin.thickness_mm;
    worst.outward_mm = std::max(worst.outward_mm, off);
    worst.inward_mm = std::max(worst.inward_mm, -off);
  }
  return worst;
}

Eigen::Vector3d onto_m1(const Eigen::Vector3d& p, const Skin& skin) {
  Eigen::Vector3d q = p;
  for (int step = 0; step < 5; ++step) {
    const double off = skin.field.at(q) + skin.thickness_mm;
    const Eigen::Vector3d gradient = skin.field.gradient(q);
    const double slope = gradient.squaredNorm();
    if (slope < 0.25) break;  // on the medial axis
    q -= off / slope * gradient;
    if (std::abs(off) < 0.05 * skin.voxel_mm) break;
  }
  return q;
}

std::optional<Eigen::Vector3d> first_on_m1(const Eigen::Vector3d& from, const Eigen::Vector3d& normal,
                                           double reach_mm, const Skin& skin) {
  const auto off = [&](double t) { return skin.field.at(from + t * normal) + skin.thickness_mm; };
  const double start = off(0.0), sign = start < 0.0 ? 1.0 : -1.0;
  double before = 0.0;
  for (double t = skin.voxel_mm; t <= reach_mm; t += skin.voxel_mm) {
    if ((off(sign * t) < 0.0) != (start < 0.0)) {
      double after = t;
      for (int i = 0; i < kBisections; ++i) {
        const double half = 0.5 * (before + after);
        ((off(sign * half) < 0.0) == (start < 0.0) ? before : after) = half;
      }
      return from + sign * before * normal;
    }
    before = t;
  }
  return std::nullopt;
}

}  // namespace skinframe
