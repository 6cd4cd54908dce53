// SPDX-License-Identifier: GPL-3.0-or-later
// Cuts a polygon, convex or not, into triangles by ear clipping (Meisters 1975) in the plane of its Newell
// normal. Gives corners - 2 triangles with the polygon's own orientation.
//
// Returns false when at some point no ear was left (self-crossing or collapsed outline) and the rest was
// fanned from its first corner: closed neighbours stay closed, the shape of that face is a guess.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

namespace skinframe {

bool triangulate_polygon(std::span<const int> corners, const std::vector<Eigen::Vector3d>& vertices,
                         std::vector<std::array<int, 3>>& triangles);

}  // namespace skinframe
