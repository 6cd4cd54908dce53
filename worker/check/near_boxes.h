// SPDX-License-Identifier: GPL-3.0-or-later
// The pairs of boxes that overlap: the check's own broad phase, for a million boxes in a second or two.
#pragma once

#include <Eigen/Geometry>
#include <functional>
#include <vector>

namespace skinframe::check {

// Calls visit(i, j), i < j, once for each two boxes that overlap or touch. Columns along x on a grid of y and
// z; in each the boxes in order of their lower end. Boxes that are large beside the columns stand in many:
// the columns widen until the boxes stand in no more than twenty million places altogether.
void for_each_overlap(const std::vector<Eigen::AlignedBox3d>& boxes,
                      const std::function<void(int, int)>& visit);

}  // namespace skinframe::check
