// SPDX-License-Identifier: GPL-3.0-or-later
// A frame of any wanted size in a second, the same on every machine: an ellipsoid cut flat at z = 0, a
// geodesic skin of 10 f^2 + 2 nodes (about 0.58 of all), internal nodes spread by best candidates, and from
// each internal node struts to its nearest nodes, rank by rank until the wanted number is there.
//
// Invariants: exactly `nodes` nodes and `struts` struts; the skin triangulation is closed and manifold, 3 n -
// 6 edges; every strut is inside the ellipsoid, which is convex. Material: PA; radii 0.5..1 mm on the skin,
// 0.5..5 mm inside; skin of 1 mm; limit 0.05 mm; no load case yet; internal nodes are free to move.
#pragma once

#include "worker/mechanics/frame_problem.h"

namespace skinframe::bench {

struct FrameSize {
  int nodes = 500, struts = 3000;
};

// Size: 60 <= nodes <= 100000 and struts between four and twelve times that. Aborts beyond: the caller has
// checked.
FrameProblem make_ellipsoid(const FrameSize& size);

bool is_possible(const FrameSize& size);

}  // namespace skinframe::bench
