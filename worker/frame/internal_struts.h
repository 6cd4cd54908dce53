// SPDX-License-Identifier: GPL-3.0-or-later
// The struts between nodes: from each internal node to its nearest nodes, and through the solid necks between
// the pieces of M1. Only struts that are inside (convex_region.h) are made.
#pragma once

#include <vector>

#include "worker/frame/frame.h"
#include "worker/skin/build_skin.h"

namespace skinframe {

// Adds to `frame` the struts of its internal nodes: the nearest `neighbours` nodes are tried, and where fewer
// than four fit, the next ones up to three times as many. Then takes out, until none is left, every internal
// node with fewer than three struts (nothing holds it) or without a path to the skin.
void add_internal_struts(Frame& frame, double radius_mm, int neighbours, const Skin& skin);

// piece_of: the piece of each skin node. Adds struts between nodes of different pieces, up to four a joint,
// where a strut of the radius stays inside M, the nearest pieces first. Returns for each piece whether it
// hangs together with piece 0.
std::vector<bool> join_pieces(Frame& frame, const std::vector<int>& piece_of, double radius_mm,
                              const Skin& skin);

}  // namespace skinframe
