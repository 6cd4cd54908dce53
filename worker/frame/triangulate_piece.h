// SPDX-License-Identifier: GPL-3.0-or-later
// One piece of M1 with some 100 000 triangles becomes a triangulation of a few hundred skin nodes.
//
// Collapse of the edge that is shortest against the wanted length, down to the count; rounds of edge flips
// (Delaunay), weighted Lloyd steps (a node goes to the centroid of its triangles, weighted by area / a^4) and
// projection to M1; then L-BFGS on the energy of the restricted Voronoi tessellation (cvt_energy.h), flips,
// and two more rounds. README.md says why both. No step changes the topology, so the result is closed and
// edge-manifold as the piece is, with its genus. An unconstrained clustering dual was not (m).
#pragma once

#include <utility>
#include <vector>

#include "worker/frame/sharp_chains.h"
#include "worker/mesh/triangle_mesh.h"
#include "worker/run/run_context.h"

namespace skinframe {

struct PieceSampling {
  std::vector<double> edge_length_mm;  // wanted, one a vertex of the piece
  int nodes = 0;                       // wanted count, >= 4
  std::vector<int> pins;               // vertices of the piece that stay where they are and stay nodes
  SharpChains chains;                  // of the piece: kept, see there
  double contact_z_mm = 0.0;  // the piece's surface at or below is base contact, whose rim nodes follow
};

struct PieceTriangulation {
  TriangleMesh mesh;
  std::vector<char> on_sharp_edge;                // one a vertex: it stands on a sharp edge of M1
  std::vector<std::pair<int, int>> sharp_chords;  // edges of the mesh that follow one
};

// The count is met exactly unless the piece's topology, its pins or its chains' corners need more nodes.
Result<PieceTriangulation> triangulate_piece(const TriangleMesh& piece, const PieceSampling& sampling,
                                             const RunContext& context);

}  // namespace skinframe
