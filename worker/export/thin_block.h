// SPDX-License-Identifier: GPL-3.0-or-later
// Edge collapses within one box of space: what thin_out.h does in many boxes at once.
//
// Only triangles with all corners in the box change, and stay within it, since a box is convex. So boxes that
// do not overlap can be thinned at the same time and neither sees the other's changes.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "worker/mesh/triangle_mesh.h"
#include "worker/skin/triangle_tree.h"

namespace skinframe {

// A point of the surface as it was, the normal there, and the triangle of the present one that it is near to.
struct SurfacePoint {
  Eigen::Vector3f place_mm, normal;
  int triangle = 0;
};

struct ThinningState {
  TriangleMesh* mesh = nullptr;
  int exact_vertices = 0;                  // the first so many never move: they only go,
  bool exact_stay = false;                 // and not even that
  const TriangleTree* original = nullptr;  // the surface as it was, where exact answers are wanted
  std::vector<char> gone;                  // one a triangle
  std::vector<SurfacePoint> points;
  std::vector<int> points_of, first_point;  // points_of[first_point[t] ...] are the points of triangle t
};

struct ThinningBlock {
  Eigen::AlignedBox3d box;
  std::vector<int> own;     // triangles with all corners in the box, in ascending order
  std::vector<int> beside;  // other triangles that may reach into it: they stay
};

struct BlockLimits {
  double quadric_mm = 0.0;  // root of the mean squared distance to the planes that went into a vertex
  // Of every point from the triangles that took the place of its own, and of the corners and middles of
  // these from the surface as it was, as far as the points about tell or the tree does.
  double deviation_mm = 0.0;
  bool is_bounded = true;     // false: neither the deviation is looked at nor whether triangles meet,
  bool is_clear = false;      // but for the latter where this is true
  std::size_t triangles = 0;  // no fewer of `own` shall be left
};

// Writes to the state's places that belong to the block's own triangles alone.
void thin_block(ThinningState& state, const ThinningBlock& block, const BlockLimits& limits);

}  // namespace skinframe
