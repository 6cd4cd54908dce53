// SPDX-License-Identifier: GPL-3.0-or-later
// CGAL's half-edge mesh as the sampling uses it. Includes CGAL: for .cpp files of this room only.
#pragma once

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>

#include <Eigen/Core>

namespace skinframe {

using Kernel = CGAL::Simple_cartesian<double>;
using HalfEdgeMesh = CGAL::Surface_mesh<Kernel::Point_3>;

// What a node carries through collapse and relaxation.
struct NodeTraits {
  double edge_length_mm = 0.0;  // wanted about here
  bool pinned = false;
};
using NodeTraitsMap = HalfEdgeMesh::Property_map<HalfEdgeMesh::Vertex_index, NodeTraits>;

inline Eigen::Vector3d to_eigen(const Kernel::Point_3& p) { return {p.x(), p.y(), p.z()}; }
inline Kernel::Point_3 to_cgal(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }

// Collapses to `nodes` vertices, or as near as the topology lets it.
void collapse_to_count(HalfEdgeMesh& mesh, NodeTraitsMap traits, int nodes);

}  // namespace skinframe
