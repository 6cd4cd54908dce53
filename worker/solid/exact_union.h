// SPDX-License-Identifier: GPL-3.0-or-later
// The one boolean for which overlapping bodies need CGAL; the header is free of it. Internal to the room.
#pragma once

#include <optional>
#include <vector>

#include "worker/mesh/triangle_mesh.h"
#include "worker/run/run_context.h"

namespace skinframe {

// The union of closed bodies, each with its cavities, by corefinement: surfaces are cut along the curves
// where they meet, nothing else moves. Empty when the library cannot: a surface crosses itself where it meets
// another, or the result is not closed. `context` is asked between two bodies; empty when it was cancelled.
std::optional<TriangleMesh> unite_exactly(const std::vector<TriangleMesh>& bodies, const RunContext& context);

}  // namespace skinframe
