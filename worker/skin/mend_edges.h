// SPDX-License-Identifier: GPL-3.0-or-later
// Makes a closed surface edge-manifold as a binary STL reads it back, where corners are known by their float
// coordinates alone: OpenVDB's surfaces have single edges with four triangles, and corners that fall together
// in float.
#pragma once

#include "worker/mesh/triangle_mesh.h"

namespace skinframe {

struct EdgeMending {
  bool manifold = false;  // every edge has exactly two triangles, in opposite directions
  int edges_split = 0;
};

// Guarantees: coordinates are exact floats and distinct; no triangle has two equal corners; when the input is
// closed and oriented (every edge is run as often forth as back) the result is `manifold`. Corners that are
// equal as floats become one; triangles that lose a corner go, as do pairs of equal and opposite ones. An
// edge with 2k triangles is divided at k midpoints, one for each wedge of solid about it, each a little
// inside its wedge, so the wedges part. Such a midpoint moves by a fiftieth of the edge, some floats at least.
EdgeMending mend_edges(TriangleMesh& mesh);

// The number of edges that do not have exactly two triangles in opposite directions; by index, not by
// coordinates.
int count_bad_edges(const TriangleMesh& mesh);

}  // namespace skinframe
