// SPDX-License-Identifier: GPL-3.0-or-later
// M1 may fall into pieces that solid necks of the body hold together. Struts through those necks, from skin
// node to skin node, make one frame of them. Such a strut is held to M, not to M1 (convex_region.h).
#pragma once

#include <vector>

#include "worker/frame/frame.h"
#include "worker/skin/build_skin.h"

namespace skinframe {

// For each piece, vertices that must become nodes so that a strut of the radius can go from piece to piece
// inside M: up to four pairs for each two pieces, the shortest that are apart from each other.
std::vector<std::vector<int>> joint_pins(const std::vector<const TriangleMesh*>& pieces, double radius_mm,
                                         const Skin& skin);

// piece_of: the piece of each skin node. Adds the struts, up to four for each two pieces, the shortest first.
// Returns for each piece whether it hangs together with piece 0.
std::vector<bool> join_pieces(Frame& frame, const std::vector<int>& piece_of, double radius_mm,
                              const Skin& skin);

}  // namespace skinframe
