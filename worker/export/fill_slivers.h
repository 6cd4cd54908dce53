// SPDX-License-Identifier: GPL-3.0-or-later
// Gaps of the cavity narrower than a voxel become solid: where a strut runs just below the skin's inside, or
// two struts leave a node side by side. No powder comes out of them, and their two sides, nearer to each
// other than thinning moves them, would cut each other.
#pragma once

#include <openvdb/openvdb.h>

namespace skinframe {

// cavity: a level set in mm, negative in the cavity, whose values there are distances to the solid. A node
// stays in the cavity where one of the 26 about it is deeper by nearly the way there, as beside any wall; at
// the middle of a gap none is. Formula: value(v) = max(value(v), min over u of value(u) + |v - u| - kept),
// kept = half a voxel, so a gap w wide closes where w < 2 (voxel - kept) = one voxel. Material is only added.
void fill_slivers(openvdb::FloatGrid& cavity);

}  // namespace skinframe
