// SPDX-License-Identifier: GPL-3.0-or-later
// The wall between M and the cavity is nowhere thinner than the skin asks for. The level set alone does not
// see to that: OpenVDB hands the nearest triangle on from voxel to voxel and misses it now and then by a
// fifth of a millimetre, always towards too deep; interpolation and thinning cut corners where M is concave.
#pragma once

#include "worker/mesh/triangle_mesh.h"
#include "worker/skin/build_skin.h"
#include "worker/skin/triangle_tree.h"

namespace skinframe {

// Vertices of the cavity that stand nearer to M than the skin's thickness less kWallSlackInVoxels, by exact
// distance, go back to that thickness, away from their nearest point of M. Coordinates stay exact floats.
// Returns how many moved. body: the triangles of M.
inline constexpr double kWallSlackInVoxels = 0.1;
int keep_wall(TriangleMesh& cavity, const TriangleTree& body, const Skin& skin, double voxel_mm);

// One vertex: where it is nearer to M than least_mm it goes to the distance to_mm. True when it moved.
bool keep_wall(Eigen::Vector3d& vertex_mm, const TriangleTree& body, double least_mm, double to_mm);

// Pairs of a triangle of M and one of the cavity that cut each other: where M has a void narrower than the
// voxel the level set does not see it, and the cavity's corners may stand about it. The mesh: M's `outer`
// triangles first.
int count_cuts_of_surface(const TriangleMesh& printable, std::size_t outer, const Skin& skin);

}  // namespace skinframe
