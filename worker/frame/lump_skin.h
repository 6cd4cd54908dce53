// SPDX-License-Identifier: GPL-3.0-or-later
// The skin's weight as the mechanics sees it: its volume shared out to the skin nodes by a third of the area
// of each triangle about them, scaled so that the sum is Skin::volume_mm3 exactly (Wang et al. 2013, section
// 3).
#pragma once

#include <vector>

#include "worker/frame/frame.h"
#include "worker/skin/build_skin.h"

namespace skinframe {

// One entry a node of the frame, mm3; zero on internal nodes. Times density, the mass that the node carries.
std::vector<double> lump_skin_volume_mm3(const Frame& frame, const Skin& skin);

}  // namespace skinframe
