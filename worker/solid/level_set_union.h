// SPDX-License-Identifier: GPL-3.0-or-later
// What surfaces shut off from outside, by a distance field: takes any closed surface, however it crosses
// itself or others. Internal to the room; the header is free of OpenVDB.
#pragma once

#include <vector>

#include "worker/mesh/triangle_mesh.h"
#include "worker/run/run_context.h"

namespace skinframe {

struct LevelSetBody {
  TriangleMesh outer;                  // what it shuts off is material, also where it winds twice
  std::vector<TriangleMesh> cavities;  // what they shut off is not, except where another body fills it
};

// The boundary of the union. Edges are rounded by about half a voxel; parts thinner than a voxel may vanish.
// Closed and oriented; an edge may have four triangles where the surface touches itself.
// What it returns after a cancellation is of no use.
TriangleMesh level_set_union(const std::vector<LevelSetBody>& bodies, double voxel,
                             const RunContext& context);

// The volume that the surface shuts off from outside. Error of second order in the voxel where the surface is
// smooth.
double shut_off_volume(const TriangleMesh& mesh, double voxel);

// The voxel at which the boundary of a body of that area comes to about half a million triangles, within
// 1/1500 and 1/200 of the box's diagonal.
double level_set_voxel(double area, double diagonal);

}  // namespace skinframe
