// SPDX-License-Identifier: GPL-3.0-or-later
// Who is next to whom on a triangle mesh, and the pieces it falls into.
#pragma once

#include <vector>

#include "worker/mesh/triangle_mesh.h"

namespace skinframe {

// Neighbours of vertex v: neighbour[first[v]] .. neighbour[first[v + 1]], ascending, each once.
struct VertexGraph {
  std::vector<int> first;
  std::vector<int> neighbour;
};
VertexGraph vertex_graph(const TriangleMesh& mesh);

// A third of the area of the triangles about each vertex, mm2.
std::vector<double> vertex_areas(const TriangleMesh& mesh);

// The connected components (through shared vertices), the one of largest area first.
std::vector<TriangleMesh> split_pieces(const TriangleMesh& mesh);

}  // namespace skinframe
