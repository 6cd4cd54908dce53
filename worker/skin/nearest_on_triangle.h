// SPDX-License-Identifier: GPL-3.0-or-later
// The point of a triangle that is nearest to another point. Lengths in mm.
#pragma once

#include <Eigen/Core>
#include <array>

namespace skinframe {

using Corners = std::array<Eigen::Vector3d, 3>;

// Ericson, Real-Time Collision Detection, 5.1.5. One of its corners where the triangle has no area.
Eigen::Vector3d nearest_on_triangle(const Eigen::Vector3d& point, const Corners& triangle);

}  // namespace skinframe
