// SPDX-License-Identifier: GPL-3.0-or-later
// CGAL's half-edge mesh as the sampling uses it. Includes CGAL: for .cpp files of this room only.
#pragma once

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>

#include <Eigen/Core>

#include "worker/frame/sharp_chains.h"

namespace skinframe {

using Kernel = CGAL::Simple_cartesian<double>;
using HalfEdgeMesh = CGAL::Surface_mesh<Kernel::Point_3>;

// What a node carries through collapse and relaxation.
struct NodeTraits {
  double edge_length_mm = 0.0;  // wanted about here
  bool pinned = false;
  int chain_vertex = -1;  // by its name in SharpChains; -1 on none
};
using NodeTraitsMap = HalfEdgeMesh::Property_map<HalfEdgeMesh::Vertex_index, NodeTraits>;

inline Eigen::Vector3d to_eigen(const Kernel::Point_3& p) { return {p.x(), p.y(), p.z()}; }
inline Kernel::Point_3 to_cgal(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

// Collapses to `nodes` vertices, or as near as the topology lets it. Chains of sharp edges stay chains: their
// vertices collapse onto each other along them, others onto them, never the other way.
void collapse_to_count(HalfEdgeMesh& mesh, NodeTraitsMap traits, SharpChains& chains, int nodes);

}  // namespace skinframe
