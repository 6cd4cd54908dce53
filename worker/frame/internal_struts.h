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

}  // namespace skinframe
