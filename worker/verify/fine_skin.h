// SPDX-License-Identifier: GPL-3.0-or-later
// The skin triangulation of a frame, fine enough for a shell: each triangle divided in four, `levels` times,
// new nodes taken to M1: to its nearest point, or where that is round a ridge along the normal; folds and
// slivers that this makes are mended (relax_skin.h). As an inscribed polyhedron it would thin limbs; divided
// and projected it does not. Flanges much thinner than the frame's triangles stay crumpled.
//
// Where the object stands, stress is concentrated, and a support of single nodes would give way the more the
// finer the mesh is. So the contact is a part of the surface, all that lies at or below a height: triangles
// about its rim are divided kRimLevels times more (their neighbours in two, which keeps the angles), and
// nodes near to the rim are moved onto it.
//
// Guarantees: nodes 0 .. frame.skin_node_count-1 are the frame's own, in place. Normals are unit vectors,
// outward. Each skin strut is a chain of edges.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "worker/frame/frame.h"
#include "worker/skin/build_skin.h"

namespace skinframe {

inline constexpr int kRimLevels = 2;

struct FineSkin {
  Frame frame;  // nodes on M1 and the fine triangles, no struts
  std::vector<Eigen::Vector3d> normals;
  std::vector<char> in_contact;          // one a node: at or below the height; none of them without a height
  std::vector<std::vector<int>> chains;  // one a strut of the coarse frame: its nodes from a to b; empty for
                                         // internal struts
};

FineSkin refine_skin(const Frame& frame, const Skin& skin, int levels,
                     const std::optional<double>& contact_below_mm = std::nullopt);

// Nodes after so many levels, of a closed triangulation, those about the rim of the contact aside: about
// fourfold each time.
std::size_t fine_node_count(const Frame& frame, int levels);

}  // namespace skinframe
