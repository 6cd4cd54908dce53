// SPDX-License-Identifier: GPL-3.0-or-later
// What of the void within a solid hangs together with the outside: the solid cut into columns along z, each a
// list of intervals that are void; intervals of neighbouring columns that overlap are one void.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "worker/mesh/triangle_mesh.h"

namespace skinframe::check {

struct VoidPart {
  double volume_mm3 = 0;
  Eigen::Vector3d centre_mm = Eigen::Vector3d::Zero();
};

struct VoidVolumes {
  double reached_mm3 = 0;             // below something solid and above something solid, with a way out
  double sealed_mm3 = 0;              // no way out
  std::vector<VoidPart> sealed;       // the largest first
  std::size_t columns = 0, torn = 0;  // torn: crossings that do not add up, taken as solid
};

// spacing_mm: of the columns; a wall thinner than that across may be overlooked. Triangles counter-clockwise
// seen from outside of the solid.
VoidVolumes flood_void(const TriangleMesh& closed_mesh, double spacing_mm);

}  // namespace skinframe::check
