// SPDX-License-Identifier: GPL-3.0-or-later
// The booleans for which overlapping bodies need CGAL; the header is free of it. Internal to the room.
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

// A closed surface that crosses itself, cut along its own crossings, without the patches that lie within. The
// library calls this experimental: it may keep the wrong patches, so the caller compares volumes. Empty when
// it gives up or crossings are left.
std::optional<TriangleMesh> unite_with_itself(const TriangleMesh& body);

}  // namespace skinframe
