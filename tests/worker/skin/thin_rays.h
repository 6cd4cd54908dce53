// SPDX-License-Identifier: GPL-3.0-or-later
// The thin volume of a body by brute force: exact rays along inward normals and exact distances to the
// triangles, no level set and no lattice. The slow oracle of thin_parts.h.
#pragma once

#include "worker/mesh/triangle_mesh.h"

namespace skinframe::oracle {

struct ThinByRays {
  double volume_mm3 = 0;
  double thin_surface_share = 0;  // of the area: inward normal shorter than two skins
};

// One ray in every square of side_mm of the surface.
ThinByRays thin_by_rays(const TriangleMesh& closed_mesh, double thickness_mm, double side_mm);

}  // namespace skinframe::oracle
