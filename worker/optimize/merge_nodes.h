// SPDX-License-Identifier: GPL-3.0-or-later
// Contraction of struts: a strut whose length vanishes in GeoOpt takes its two nodes together, and the frame
// has a node and at least a strut less.
#pragma once

#include <optional>
#include <vector>

#include "worker/optimize/design.h"

namespace skinframe {

// Struts of free nodes that are shorter than share * the mean length of all such struts, shortest first, no
// two of them at a common node.
std::vector<int> contractible_struts(const Design& design, double share);

// The design with both ends of each strut listed in one place: where the end stands that does not move, or
// half way. Struts that then join the same nodes become one with their areas added; of a skin strut and an
// internal one the skin strut stays. A node that takes another one in keeps its own origin. Areas are not
// sized; volume_mm3 is 0. None when a strut listed joins two nodes that do not move.
std::optional<Design> contracted_design(const Design& design, const std::vector<int>& struts);

}  // namespace skinframe
