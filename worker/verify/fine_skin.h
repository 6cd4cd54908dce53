// SPDX-License-Identifier: GPL-3.0-or-later
// The skin triangulation of a frame, fine enough for a shell: each triangle divided in four, `levels` times,
// new nodes taken to M1. As an inscribed polyhedron it would thin limbs; divided and projected it does not.
//
// Guarantees: nodes 0 .. frame.skin_node_count-1 are the frame's own, in place. Normals are unit vectors,
// outward.
#pragma once

#include <array>
#include <vector>

#include "worker/frame/frame.h"
#include "worker/skin/build_skin.h"

namespace skinframe {

struct FineSkin {
  Frame frame;  // nodes on M1 and the fine triangles, no struts
  std::vector<Eigen::Vector3d> normals;
  std::vector<std::array<int, 2>> parents;  // of node i >= coarse count: ends of the edge that it halves
  std::vector<std::vector<int>> chains;  // one a strut of the coarse frame: its nodes from a to b; empty for
                                         // internal struts
};

FineSkin refine_skin(const Frame& frame, const Skin& skin, int levels);

// Nodes after so many levels, of a closed triangulation: about fourfold each time.
std::size_t fine_node_count(const Frame& frame, int levels);

}  // namespace skinframe
