// SPDX-License-Identifier: GPL-3.0-or-later
// A printer's p(theta) asked about a piece of a strut.
#pragma once

#include <Eigen/Core>

#include "worker/profile/printable_length.h"

namespace skinframe {

inline constexpr double kLengthTolerance = 1e-9;  // relative, of a length against p(theta)

// Of the line through two points with the vertical, in radians, 0 .. pi/2.
double angle_from_vertical(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

// Whether a straight piece between two points prints without support in between.
bool prints(const PrintableLength& curve, const Eigen::Vector3d& a, const Eigen::Vector3d& b);

// The flattest angle from the vertical, in radians, at which the curve knows no limit; 45 degrees, the common
// practice, where it limits every angle.
double self_supporting_angle(const PrintableLength& curve);

}  // namespace skinframe
