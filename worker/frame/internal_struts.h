// SPDX-License-Identifier: GPL-3.0-or-later
// The struts between nodes: from each internal node to its nearest nodes. Only struts that are inside
// (convex_region.h), clear of each other and of the drain holes are made.
#pragma once

#include <optional>
#include <vector>

#include "worker/drain/opening.h"
#include "worker/frame/frame.h"
#include "worker/skin/build_skin.h"

namespace skinframe {

struct InternalStruts {
  double radius_mm = 0.5;             // eta
  std::optional<double> slenderness;  // alpha: a strut's lower bound is max(eta, l / alpha)
  int neighbours = 9;
  std::vector<Opening> openings;  // drain holes: no strut comes into one
};

struct InternalStrutCounts {
  int struts_crossing = 0;  // left out: nearer to a better one than both lower bounds allow
  int nodes_added = 0;      // on the way round a concave part
};

// Adds to `frame` the struts of its internal nodes:
//  1. the nearest `neighbours` nodes are tried, and where fewer than four fit, the next ones up to three
//  times
//     as many;
//  2. where then fewer than four fit still, struts that leave M1 are divided at a node that is moved inwards
//     (local subdivision in concave regions, section 4.2), if both halves fit;
//  3. of two struts without a common node whose axes are nearer than the sum of their least radii, the longer
//     internal one goes; skin struts and those between pieces stay;
//  4. internal nodes with fewer than three struts (nothing holds them) or without a path to the skin go,
//  until
//     none is left.
InternalStrutCounts add_internal_struts(Frame& frame, const InternalStruts& options, const Skin& skin);

// Smallest distance of two segments.
double segment_distance_mm(const Eigen::Vector3d& a0, const Eigen::Vector3d& a1, const Eigen::Vector3d& b0,
                           const Eigen::Vector3d& b1);

}  // namespace skinframe
