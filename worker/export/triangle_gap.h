// SPDX-License-Identifier: GPL-3.0-or-later
// Whether two triangles stay clear of each other, and how far a point is from one: by floating point alone
// and on the safe side, for millions of questions. Lengths in mm.
#pragma once

#include <Eigen/Core>

#include "worker/skin/nearest_on_triangle.h"

namespace skinframe {

// A plane parts the two with at least kLeastGapMm between them. False also where rounding leaves it open.
inline constexpr double kLeastGapMm = 1e-6;
bool are_apart(const Corners& a, const Corners& b);

// Triangles with the corner a[0] = b[0] in common meet nowhere else. False where that is open.
bool meet_in_their_corner_only(const Corners& a, const Corners& b);

inline double squared_distance(const Eigen::Vector3d& point, const Corners& triangle) {
  return (point - nearest_on_triangle(point, triangle)).squaredNorm();
}

}  // namespace skinframe
