// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/support/printable_curve.h"

#include <cmath>
#include <numbers>

namespace skinframe {

double angle_from_vertical(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d d = b - a;
  return std::atan2(d.head<2>().norm(), std::abs(d.z()));
}

bool prints(const PrintableLength& curve, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return (b - a).norm() <= curve.length_mm(angle_from_vertical(a, b)) * (1.0 + kLengthTolerance);
}

double self_supporting_angle(const PrintableLength& curve) {
  double degrees = -1;
  for (const PrintableLength::Point& point : curve.points())
    if (!point.length_mm) degrees = point.angle_deg;
  return (degrees > 0 ? degrees : 45) * std::numbers::pi / 180;
}

}  // namespace skinframe
