// SPDX-License-Identifier: GPL-3.0-or-later
// A half-space, and the convex region in which each movable node must stay (Wang et al. 2013, eq. 7).
#pragma once

#include <Eigen/Core>
#include <vector>

namespace skinframe {

struct HalfSpace {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit length, pointing out of the region
  double offset_mm = 0;                               // the region: normal . x <= offset_mm
};

// One list a node, all of them hold; empty for a node that does not move.
using NodeRegions = std::vector<std::vector<HalfSpace>>;

}  // namespace skinframe
