// SPDX-License-Identifier: GPL-3.0-or-later
// Drain holes in the skin's triangulation: what stands within a rim that the triangulation follows goes.
#pragma once

#include <utility>
#include <vector>

#include "worker/drain/opening.h"
#include "worker/mesh/triangle_mesh.h"

namespace skinframe {

// Takes the triangles within the opening's rim out of a triangulation of M1, and the vertices that no
// triangle has any more; `chords`, the edges that follow curves, the rim among them, are renumbered. No edge
// that stays is nearer to the opening than a strut as thick as the skin may be. False, and nothing is
// changed, where the rim is no closed chain of chords about the axis, or where such an edge stays all the
// same.
bool open_rim(TriangleMesh& mesh, std::vector<std::pair<int, int>>& chords, const Opening& opening,
              double skin_thickness_mm);

// Whether the surface stands at the rim: which of several pieces of M1 an opening belongs to.
bool has_rim(const TriangleMesh& piece, const SharpCurve& rim, double reach_mm);

}  // namespace skinframe
