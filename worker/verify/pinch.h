// SPDX-License-Identifier: GPL-3.0-or-later
// Two fingers that press the object together: 10 N each on a contact of 10 mm, at sites spread evenly over
// it.
//
// A site is a node of the fine skin and the point where a ray inward from it leaves M: the walls there have
// to look away from each other. Sites are chosen furthest first, starting with the thickest. The two patches
// get forces along the line of their centres, so that a pinch is in balance by itself, force and moment.
#pragma once

#include <vector>

#include "worker/skin/triangle_tree.h"
#include "worker/structure/structure.h"
#include "worker/verify/fine_skin.h"

namespace skinframe {

inline constexpr double kPinchForceN = 10;   // f, the paper's finger
inline constexpr double kPinchRadiusMm = 5;  // half of its contact b
inline constexpr std::size_t kPinchSites = 40;

struct PinchSite {
  int node = 0;      // of the fine skin, where one finger is
  int opposite = 0;  // the node nearest to where the other one is
  double apart_mm = 0;
};

// Fewer than asked for where the object offers fewer.
std::vector<PinchSite> spread_pinches(const FineSkin& fine, const Skin& skin, const TriangleTree& body,
                                      std::size_t sites = kPinchSites);

// One column a site, for any structure on this fine skin. The closing distance of the patches is f . d /
// kPinchForceN.
NodalColumns pinch_columns(const Structure& structure, const FineSkin& fine,
                           const std::vector<PinchSite>& sites);

}  // namespace skinframe
