// SPDX-License-Identifier: GPL-3.0-or-later
// Equation (7) of Wang et al. 2013: where an internal node may move so that its struts stay inside M1.
//
// For every internal strut a polytope is inflated about its axis: take the point p of M1 nearest to the
// strut, c the point of the strut nearest to p, n = (p - c)/|p - c|, and add the plane n.x <= n.p - r -
// margin; forget what lies beyond it, repeat until no point is left. Two axes inside one such polytope are
// joined by a segment inside it, so a strut whose both ends stay there stays clear of M1 by its radius. Near
// a skin end, where no strut can be clear, the plane passes through the skin end instead and opens towards p
// (required_depth_mm says what is asked there). A node's region is the intersection over its struts, with a
// box about its place that bounds one pass.
//
// Guarantees:
//  1. regions.size() == frame.nodes_mm.size(); skin nodes have no half-spaces (they do not move).
//  2. Every internal node satisfies its own half-spaces where it stands.
//  3. When all nodes stay in their regions and radii do not grow, struts_inside() keeps holding (up to M1's
//  sampling
//     of about 1 mm).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "worker/frame/frame.h"
#include "worker/frame/half_space.h"
#include "worker/skin/build_skin.h"

namespace skinframe {

// radii_mm: one a strut of the frame.
NodeRegions convex_regions(const Frame& frame, const std::vector<double>& radii_mm, const Skin& skin);

// How deep below M1 the axis of an internal strut must run at distance t from its skin end: min(r, 0.2 t).
// Away from skin ends it is r. So a strut is clear of M1 by its radius except where it grows out of the
// surface, which it leaves at some 12 degrees at least.
double required_depth_mm(double radius_mm, double distance_from_skin_end_mm);

// By how much one internal strut comes nearer to M1 than required, at its worst point, mm; <= 0 is inside. A
// strut between two skin nodes joins two pieces of M1 through solid material: it is held to M, not to M1.
double strut_excess_mm(const Frame& frame, const Strut& strut, double radius_mm, const Skin& skin);

// The worst of all internal struts; -infinity when there are none.
double worst_strut_excess_mm(const Frame& frame, const std::vector<double>& radii_mm, const Skin& skin);

// What the distance field cannot tell: a third of its voxel.
double inside_tolerance_mm(const Skin& skin);

// The largest radius with which each internal strut is inside where it stands (tolerance included); infinite
// for skin struts and where only the slope at the skin ends counts. An upper bound of r_j beside the paper's
// (10).
std::vector<double> strut_clearance_mm(const Frame& frame, const Skin& skin);

// worst_strut_excess_mm() within inside_tolerance_mm().
bool struts_inside(const Frame& frame, const std::vector<double>& radii_mm, const Skin& skin);

}  // namespace skinframe
