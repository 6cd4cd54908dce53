// SPDX-License-Identifier: GPL-3.0-or-later
// Which boxes overlap or touch each other.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <utility>
#include <vector>

namespace skinframe {

// All pairs (i < j) whose boxes have a point in common and which keep(i, j) holds, in ascending order; the
// same at any number of threads. keep is called from several.
std::vector<std::pair<int, int>> touching_pairs(const std::vector<Eigen::AlignedBox3f>& boxes,
                                                const std::function<bool(int, int)>& keep);

}  // namespace skinframe
