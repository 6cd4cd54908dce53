// SPDX-License-Identifier: GPL-3.0-or-later
// First steps of repair(): one vertex a point, no triangle twice. Internal to the room.
#pragma once

#include <cstddef>

#include "worker/mesh/triangle_mesh.h"

namespace skinframe {

// Joins every vertex to the first one (by number) that represents a point within `tolerance` (same unit as
// the mesh; 0 joins equal points). Returns how many vanished. Triangles keep their place and may become
// degenerate.
std::size_t weld(TriangleMesh& mesh, double tolerance);

// Drops triangles that name a vertex twice.
std::size_t drop_degenerate(TriangleMesh& mesh);

struct DuplicateCounts {
  std::size_t repeated = 0;  // copies beyond the first
  std::size_t walls = 0;     // doubled triangles that part two bodies from within, dropped altogether
};

// Of triangles on the same three vertices, either way round, one stays; none where they are an inner wall,
// that is, where the rest of the surface goes on past one of their edges without them.
DuplicateCounts drop_duplicates(TriangleMesh& mesh);

}  // namespace skinframe
