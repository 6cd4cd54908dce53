// SPDX-License-Identifier: GPL-3.0-or-later
// Pairs of triangles of one surface that cut each other: by exact predicates on the coordinates as they are,
// free of CGAL in this header.
#pragma once

#include <utility>
#include <vector>

#include "worker/mesh/triangle_mesh.h"

namespace skinframe {

// Triangles that meet beyond the corner or side they share; pairs in ascending order. Of two on one side only
// the fold onto each other counts, up to a fraction of a degree.
std::vector<std::pair<int, int>> crossing_triangles(const TriangleMesh& mesh);

// The same among the triangles given by number.
std::vector<std::pair<int, int>> crossing_triangles(const TriangleMesh& mesh, const std::vector<int>& among);

}  // namespace skinframe
