// SPDX-License-Identifier: GPL-3.0-or-later
// Internal to the room; the header is free of CGAL.
#pragma once

#include <cstddef>

#include "worker/mesh/triangle_mesh.h"

namespace skinframe {

// Pairs of triangles that cut or overlap each other beyond what they share (exact predicates).
std::size_t count_self_intersections(const TriangleMesh& mesh);

}  // namespace skinframe
