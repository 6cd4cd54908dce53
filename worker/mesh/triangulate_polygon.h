// SPDX-License-Identifier: GPL-3.0-or-later
// Cuts a polygon, convex or not, into triangles by ear clipping (Meisters 1975) in the plane of its Newell
// normal. Gives corners - 2 triangles with the polygon's own orientation.
//
// kGuessed: at some point no ear was left (self-crossing or collapsed outline) and the rest was fanned from
// its first corner: closed neighbours stay closed, the shape of that face is a guess.
// kTooLong: an outline made for it takes the cube of its corners in steps, minutes for a few thousand; with
// *steps_left used up nothing more is cut. A step looks at one corner.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace skinframe {

enum class Triangulation { kClean, kGuessed, kTooLong };

Triangulation triangulate_polygon(std::span<const int> corners, const std::vector<Eigen::Vector3d>& vertices,
                                  std::vector<std::array<int, 3>>& triangles, std::uint64_t* steps_left);

}  // namespace skinframe
