// SPDX-License-Identifier: GPL-3.0-or-later
// The sharp edges of M1: where two faces of M meet outwards, their offsets at h_S meet as sharply. (Where
// they meet inwards the offset is round.)
//
// Found on M's own triangles, because the level set's surface has bevels in their place: an edge of M whose
// faces turn outwards by kSharpAngleDegrees or more is one; at a corner of M the point of M1 is the one h_S
// below all faces about it, x = q - h_S y with n_i . y = 1 by least squares; and each step along the edge
// counts only where the distance field says that it is on M1. Edges that hang together without a bend or a
// fork are one curve.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "worker/mesh/triangle_mesh.h"
#include "worker/skin/distance_field.h"

namespace skinframe {

inline constexpr double kSharpAngleDegrees = 50.0;       // between the normals of the two faces
inline constexpr double kSharpBendDegrees = 40.0;        // along a curve: a sharper bend is a corner
inline constexpr double kLeastCurveInThicknesses = 6.0;  // shorter ones are no edges of the body

struct SharpCurve {
  std::vector<Eigen::Vector3d> points_mm;  // on M1, at most one coarse voxel apart; first = last when closed
  bool closed = false;
  int corners = 0;  // of a closed one that is wanted for its own sake: that many of its nodes, evenly spread
  double length_mm() const;
};

// In the order of M's vertices.
std::vector<SharpCurve> find_sharp_edges(const TriangleMesh& closed_mesh, const DistanceField& field,
                                         double thickness_mm);

}  // namespace skinframe
