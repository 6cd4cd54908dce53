// SPDX-License-Identifier: GPL-3.0-or-later
// Skin struts follow the skin: an edge of the skin triangulation whose chord leaves M1 too far is flipped or
// divided until it does not, so that a strut that the mechanics counts is a strut that is printed.
//
// An edge that deviates is first flipped, where the other diagonal of its two triangles deviates less and
// keeps their angles. What still deviates is divided, the worst first: a node at its middle, taken to M1, and
// its two triangles become four; then Delaunay flips about, which never make an edge that deviates, and
// rounds that move nodes along M1 where that widens the least angle about. The mesh stays closed,
// edge-manifold and of its genus.
#pragma once

#include <utility>
#include <vector>

#include "worker/frame/frame.h"
#include "worker/frame/on_m1.h"
#include "worker/run/run_context.h"
#include "worker/skin/build_skin.h"

namespace skinframe {

// How far the axis of a skin strut may stand from M1, as shares of h_S. Outwards a little less than the skin,
// so that the axis stays inside M: at its outermost a strut is printed as the half that is in M, as the
// skin's own half discs are. Inwards nothing is lost to the print, so there only the coarse is mended.
inline constexpr double kOutwardInThicknesses = 0.9;
inline constexpr double kInwardInThicknesses = 2.0;
// At most this share of nodes is added; the worst struts are divided first.
inline constexpr double kMostAdded = 0.2;
// Shorter edges are not divided.
inline constexpr double kShortestDividedInThicknesses = 2.0;

struct SkinFollowing {
  int nodes_added = 0;
  int edges_flipped = 0;
  int edges_left = 0;  // that still deviate: too short to divide, or beyond the bound on nodes
};

// Vertices keep their numbers, those that are held (one a vertex) their places; new ones come after. kept:
// edges that are never flipped; where one is divided, its halves are kept and the new node is held.
// Afterwards `kept` are the edges that they have become.
Result<SkinFollowing> follow_skin(TriangleMesh& mesh, const std::vector<char>& held,
                                  std::vector<std::pair<int, int>>& kept, const Skin& skin,
                                  const RunContext& context);

}  // namespace skinframe
