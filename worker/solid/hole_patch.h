// SPDX-License-Identifier: GPL-3.0-or-later
// The one call for which fill_holes needs CGAL; the header is free of it. Internal to the room.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace skinframe {

// Triangles over the numbers of the closed polyline's points (the last joins the first) that pass each of its
// edges i -> i + 1. Empty when the library finds none.
std::vector<std::array<int, 3>> triangulate_closed_polyline(const std::vector<Eigen::Vector3d>& points);

}  // namespace skinframe
