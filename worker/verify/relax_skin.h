// SPDX-License-Identifier: GPL-3.0-or-later
// Mends a triangulation of M1 where it is folded or has slivers, by moving nodes over M1.
//
// A node's score is the least over its triangles of 4 sqrt(3) area / (sum of squared sides), 1 for equal
// sides, and over its edges of 1 + cosine between the normals beside, 0 for a fold. Nodes that score less
// than kGoodScore, or stand off M1, try the middle of their neighbours, half the way there, and where they
// stand, each taken to M1 by the shortest way and along the normal; the best is taken where it is better.
#pragma once

#include <vector>

#include "worker/frame/frame.h"
#include "worker/skin/build_skin.h"

namespace skinframe {

inline constexpr double kGoodScore = 0.35;

// Nodes from first_node on may move.
void relax_skin(const Skin& skin, int first_node, Frame* frame);

}  // namespace skinframe
