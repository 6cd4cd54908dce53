// SPDX-License-Identifier: GPL-3.0-or-later
// Cracks without width, where a long edge lies along several short ones (T-junctions of CAD exports).
// Internal to the room.
#pragma once

#include <cstddef>

#include "worker/mesh/triangle_mesh.h"

namespace skinframe {

// Splits boundary edges at the boundary vertices that lie within `tolerance` of them, so that they meet the
// edges on the other side; no vertex moves. Returns how many splits were made. Leaves meshes of very many
// boundary edges alone: every edge is compared with every vertex.
std::size_t split_at_touching_vertices(TriangleMesh& mesh, double tolerance);

}  // namespace skinframe
