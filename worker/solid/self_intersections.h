// SPDX-License-Identifier: GPL-3.0-or-later
// Internal to the room; the header is free of CGAL.
#pragma once

#include <utility>
#include <vector>

#include "worker/mesh/triangle_mesh.h"

namespace skinframe {

// Pairs of triangles, by their numbers, that cut or overlap each other beyond what they share (exact
// predicates). Expects at most two triangles an edge.
std::vector<std::pair<int, int>> find_self_intersections(const TriangleMesh& mesh);

}  // namespace skinframe
