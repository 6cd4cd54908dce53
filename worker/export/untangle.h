// SPDX-License-Identifier: GPL-3.0-or-later
// Takes out the few places where a level set's surface, thinned and rounded to floats, cuts itself.
//
// The corners of triangles that cross go half way to the mean of their neighbours, round by round and in a
// growing neighbourhood, until none cross; where that does not do, the round that left the fewest counts. A
// corner moves by less than its edges are long; the connections stay, so a closed manifold stays one.
// Coordinates stay exact floats.
#pragma once

#include <functional>

#include "worker/mesh/triangle_mesh.h"
#include "worker/run/run_context.h"

namespace skinframe {

struct Untangling {
  int crossings_found = 0;  // pairs of triangles
  int crossings_left = 0;   // 0 but where the rounds did not do
};

// hold: called on each new place of a corner with the number of the round, may move it to where it is allowed
// to be, in exact floats.
inline constexpr int kMostUntanglingRounds = 12;
using Hold = std::function<void(Eigen::Vector3d&, int round)>;
Untangling untangle(
    TriangleMesh& mesh, const RunContext& context, const Hold& hold = [](Eigen::Vector3d&, int) {});

}  // namespace skinframe
