// SPDX-License-Identifier: GPL-3.0-or-later
// A solid as tetrahedra.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace skinframe {

struct TetMesh {
  std::vector<Eigen::Vector3d> vertices_mm;
  std::vector<std::array<int, 4>> tets;  // of positive volume: (b - a) x (c - a) . (d - a) > 0
};

double tet_volume_mm3(const TetMesh& mesh, const std::array<int, 4>& tet);
double volume_mm3(const TetMesh& mesh);

// The faces that one tetrahedron alone has, outward.
std::vector<std::array<int, 3>> boundary_of(const TetMesh& mesh);

// For each tetrahedron the component it belongs to, 0 .. n - 1 by first appearance. Components hang together
// through faces: what meets in an edge or a corner alone is a hinge, not one solid.
std::vector<int> face_components(const TetMesh& mesh);

// The tetrahedra of the component with the largest volume; vertices stay.
TetMesh largest_component(TetMesh mesh);

}  // namespace skinframe
