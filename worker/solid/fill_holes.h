// SPDX-License-Identifier: GPL-3.0-or-later
// Openings of a surface and their filling. Internal to the room. Expects consistent orientation and at most
// two triangles an edge.
#pragma once

#include <vector>

#include "worker/mesh/triangle_mesh.h"

namespace skinframe {

struct Opening {
  std::vector<int> loop;  // vertices in the sense in which filling triangles pass the edges
  double length = 0;      // of the boundary, in the mesh's unit
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  // mean of the loop's vertices
};

// In order of the lowest half-edge. A loop that passes a vertex twice is split there into simple loops.
std::vector<Opening> find_openings(const TriangleMesh& mesh);

// Whether the opening is where a plane cut the body off, like the base of a bust: the rim departs from its
// plane by at most `tolerance` of its length, and the whole mesh, which is no sheet, lies on one side of it.
inline constexpr double kFlatCutTolerance = 0.02;
bool is_flat_cut(const TriangleMesh& mesh, const Opening& opening, double tolerance = kFlatCutTolerance);

// Of the polygon of the opening, seen along its normal.
double opening_area(const TriangleMesh& mesh, const Opening& opening);

// Adds triangles that close the openings (Liepa 2003: the least worst dihedral angle, then area); where their
// inner edges would meet edges that exist, a fan from the middle of the loop instead.
void fill_openings(TriangleMesh& mesh, const std::vector<Opening>& openings);

}  // namespace skinframe
