// SPDX-License-Identifier: GPL-3.0-or-later
// Makes a soup one consistently oriented surface with at most two triangles an edge. Internal to the room.
#pragma once

#include <cstddef>

#include "worker/mesh/triangle_mesh.h"
#include "worker/run/result.h"

namespace skinframe {

// Turns triangles so that neighbours across every edge of exactly two triangles agree; each patch keeps the
// sense that most of its triangles (by area) have in the file. Returns how many were turned. Error: the
// surface is one-sided.
Result<std::size_t> orient_patches(TriangleMesh& mesh);

struct PartCounts {
  std::size_t edges = 0;     // of more than two triangles, parted into edges of two
  std::size_t vertices = 0;  // made by it
};

// Where bodies touch along an edge (four, six, ... triangles there): mates the triangles around it so that
// each pair has the material between it, and gives every umbrella of a vertex there a vertex of its own,
// `gap` towards the umbrella, so that equal coordinates do not join them again. Other vertices that several
// umbrellas share are left as they are. Error: an edge whose triangles do not alternate, an inner wall or a
// fin.
Result<PartCounts> part_touching_edges(TriangleMesh& mesh, double gap);

}  // namespace skinframe
