// SPDX-License-Identifier: GPL-3.0-or-later
// From triangles to a signed distance grid and back. Includes OpenVDB: for .cpp files of skin and export
// only.
#pragma once

#include <openvdb/openvdb.h>

#include "worker/mesh/triangle_mesh.h"

namespace skinframe {

// Distance to a closed outward mesh, negative inside; true within the two bands (in voxels), clamped beyond.
// The walls of voids too narrow for the grid, and folds within the material, count: about them the distance
// is that to them, negative.
openvdb::FloatGrid::Ptr distance_grid(const TriangleMesh& mesh, double voxel_mm, double outer_voxels,
                                      double inner_voxels);

// The surface {grid = iso_mm}, a thousandth of a voxel towards smaller values, outward (towards larger
// values), coordinates exact floats. Closed where the grid's bands hold the surface, but single edges may
// have four triangles: mend_edges() is for those. No adaptivity: OpenVDB's adaptive meshes cut themselves.
TriangleMesh iso_surface(const openvdb::FloatGrid& grid, double iso_mm);
// The same; the grid is gone before the triangles take memory.
TriangleMesh iso_surface(openvdb::FloatGrid::Ptr&& grid, double iso_mm);

}  // namespace skinframe
