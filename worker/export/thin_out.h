// SPDX-License-Identifier: GPL-3.0-or-later
// Fewer triangles for the same surface: a level set's mesh has as many on a flat wall as about a strut.
//
// Edges are collapsed in order of rounds with rising tolerance, by the quadric error of Garland and Heckbert
// 1997 (squared distances to the planes of the triangles that went into a vertex, not weighted by area; their
// mean, so that the noise of a level set does not add up). A collapse is made only where it keeps the surface
// closed and edge-manifold (the ends share two neighbours exactly), turns no triangle by more than about 60
// degrees and leaves no sliver.
#pragma once

#include "worker/mesh/triangle_mesh.h"

namespace skinframe {

// Down to `triangles` or as near as no mean above tolerance_mm^2 allows. The mesh must be closed and
// edge-manifold, and stays so; its Euler characteristic stays too.
void thin_out(TriangleMesh& mesh, std::size_t triangles, double tolerance_mm);

}  // namespace skinframe
