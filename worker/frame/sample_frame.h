// SPDX-License-Identifier: GPL-3.0-or-later
// The initial frame (Wang et al. 2013, section 4.2): skin nodes on M1 with their triangulation, evenly spread
// internal nodes, nearest-neighbour struts that stay inside M1.
//
// Skin nodes: M1 is collapsed to the wanted count, then relaxed and fitted to the density
// (triangulate_piece.h), which follows curvature and, when a map is given, the stress of the solid
// (node_count.h). The base contact is kept: nodes there stay there, its rim is followed, and three nodes not
// in line stand on it at least. Sharp edges of M1 (sharp_edges.h) keep nodes: their corners are nodes, others
// slide along, and chords follow them (sharp_chains.h). Then struts that leave M1 too far are divided
// (follow_skin.h): the nodes added there are skin nodes too. Internal nodes: Lloyd on the voxels deeper than
// a margin below M1. Default count: those that the spacing of the skin edges asks for, at most 0.35 of the
// skin nodes (the paper's frames have 0.12 to 0.44). Internal struts: from each internal node to its nearest
// nodes, where the strut with the body radius fits (required_depth_mm in convex_region.h). What does not fit
// is divided once where its node needs it, and of two struts that cross the longer is left out
// (internal_struts.h). Pieces of M1: each is a component of the triangulation. Pieces too small for a
// triangulation, and pieces that no strut through the solid neck can join to the largest, stay hollow without
// a frame; a warning says so. Drain holes: the rim of each is a chain of kRimNodes skin nodes on M1, the
// triangulation has a hole there, and no strut comes into the opening (drain/opening.h).
//
// Guarantees:
//  1. frame.h's invariants; the skin triangulation is edge-manifold, outward, of the genus of M1's kept
//  pieces, and closed but for the drain holes.
//  2. As many skin nodes sampled as asked for, unless the topology of M1 needs more (then a warning).
//  3. The frame is connected: every node has a path of struts to every contact node. No isolated node.
//  4. Same input and seed, same frame, at any thread count.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "worker/drain/opening.h"
#include "worker/frame/frame.h"
#include "worker/frame/node_count.h"
#include "worker/run/run_context.h"
#include "worker/skin/build_skin.h"
#include "worker/stress/stress_map.h"

namespace skinframe {

struct FrameOptions {
  std::optional<int> skin_nodes;      // [kMinSkinNodes, kMaxSkinNodes]; default: node_count.h
  std::optional<int> internal_nodes;  // [0, kMaxSkinNodes]; default above
  SkinPlate plate;                    // for the finger rule
  double strut_radius_mm = 0.5;       // eta: struts are tested against M1 with this radius, > 0
  double contact_tolerance_mm = 1.0;  // contact = M within this of its lowest plane, > 0
  int neighbours = 9;                 // nearest nodes tried from each internal node, [1, 64]
  std::optional<double> slenderness;  // alpha of (4): a strut's least radius is at least l / alpha, > 0
  const StressMap* stress = nullptr;  // none: the density follows curvature alone
  std::vector<Opening> openings;      // drain holes
  Status validate() const;
};

// Of the least angle of each skin triangle, in degrees.
struct TriangleAngles {
  double mean = 0.0, first_percentile = 0.0, least = 0.0;
};
TriangleAngles measure_angles(const Frame& frame);

struct SampledFrame {
  Frame frame;
  std::vector<int>
      contact_nodes;  // skin nodes above the base contact (widened when it held fewer than three)
  std::vector<std::pair<int, int>> sharp_chords;  // skin struts that follow a sharp edge of M1
  int skin_nodes_requested = 0;                   // by the option or by the count rule
  int skin_nodes_sampled = 0;  // before struts were divided; frame.skin_node_count is after
  double finger_edge_mm = 0.0;
  double mean_skin_edge_mm = 0.0;
  double worst_outward_chord_mm = 0.0;  // furthest that the axis of a skin strut stands outside of M1,
  double worst_inward_chord_mm = 0.0;   // and below it
  int skin_struts_outside = 0;          // skin struts whose axis leaves M
  int struts_left_out_crossing = 0;     // internal ones, nearer to others than their least radii allow
  TriangleAngles angles;
  int pieces = 0;                 // of M1 that have a frame
  std::vector<Opening> openings;  // of the options
  // Those of the options whose rim the triangulation cannot follow. Where there are such, this is all that is
  // filled: it is to be done again with others.
  std::vector<Opening> unopened;
  std::vector<std::string> warnings;
};

// Errors: kInvalidInput when M1 is empty (the body is thinner than two skins everywhere), when an option is
// out of range, or when the count rule asks for more than kMaxSkinNodes; kCancelled.
Result<SampledFrame> sample_frame(const Skin& skin, const FrameOptions& options, RunContext& context);

}  // namespace skinframe
