// SPDX-License-Identifier: GPL-3.0-or-later
// Edge flips on a closed surface. Includes CGAL: for .cpp files of this room only.
#pragma once

#include <functional>

#include "worker/frame/half_edge.h"

namespace skinframe {

// Whether the diagonal of the two triangles about h may change without doubling an edge, leaving a vertex of
// degree two, or folding the surface.
bool may_flip(const HalfEdgeMesh& mesh, HalfEdgeMesh::Halfedge_index h);

// Flips edges whose opposite angles sum to more than pi (Delaunay) where may_flip() and `allowed` hold, in
// five sweeps at most.
using FlipRule = std::function<bool(HalfEdgeMesh::Halfedge_index)>;
void flip_to_delaunay(HalfEdgeMesh& mesh, const FlipRule& allowed = nullptr);

double angle_at(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& r);  // radians

}  // namespace skinframe
