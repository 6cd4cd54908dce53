// SPDX-License-Identifier: GPL-3.0-or-later
// Where the frame stands: nodes that the sampling must keep on the base contact.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace skinframe {

// Of points on the contact, those to be kept as nodes: corners of its hull in xy, the three that span the
// largest triangle about first, then others at least `spacing_mm` from each other, at most 16. Fewer than
// three when all points are in line.
std::vector<int> choose_pins(const std::vector<Eigen::Vector3d>& points, double spacing_mm);

// The nodes at or below height_mm; widened upwards, lowest first, until three of them are not in line in xy.
std::vector<int> contact_nodes(const std::vector<Eigen::Vector3d>& nodes, int skin_nodes, double height_mm);

}  // namespace skinframe
