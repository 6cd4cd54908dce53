// SPDX-License-Identifier: GPL-3.0-or-later
// How thick M is, seen along the inward normals of its surface.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "worker/mesh/triangle_mesh.h"
#include "worker/skin/distance_field.h"

namespace skinframe {

// The middle of a wall: half way along an inward normal that leaves M again.
struct WallSample {
  Eigen::Vector3d middle_mm;
  double thickness_mm;  // length of the normal inside M
  double area_mm2;      // of the surface that the sample stands for
};

// Samples of the walls thinner than `limit_mm`, from points about spacing_mm apart on every triangle, in the
// order of the triangles. Thickness is exact to about a tenth of the field's voxel.
std::vector<WallSample> sample_thin_walls(const TriangleMesh& closed_mesh, const DistanceField& field,
                                          double limit_mm, double spacing_mm);

}  // namespace skinframe
