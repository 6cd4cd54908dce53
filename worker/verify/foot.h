// SPDX-License-Identifier: GPL-3.0-or-later
// Where a solid stands, as fine as its tetrahedra have to see it: feet may be far smaller than what fills the
// rest of the body, and a solid held in a few points of its foot turns about them.
#pragma once

#include "worker/mesh/triangle_mesh.h"
#include "worker/stress/tet_mesh.h"

namespace skinframe {

struct Foot {
  TriangleMesh surface;  // of the body, cut off at the top of the contact
  double top_z_mm = 0;
  double area_mm2 = 0;
  double width_mm = 0;  // twice its area in plan over its rim: radius of a disc, width of a strip; infinite
                        // without a rim
};

Foot foot_of(const TriangleMesh& body, double top_z_mm);

// Nodes of a tetrahedra's surface, corners and middles of sides, up to this height have at least the foot's
// area about them (a corner a 1/12 of each triangle, a middle 1/4): the foot's top, or higher where too few
// of them are found below.
double held_height_mm(const TetMesh& mesh, const Foot& foot);
double area_held_mm2(const TetMesh& mesh, double height_mm);

}  // namespace skinframe
