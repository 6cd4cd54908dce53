// SPDX-License-Identifier: GPL-3.0-or-later
// Drain holes cut through the skin of the merged mesh, and caps for them.
//
// At each opening M's sheet and the cavity's lose what stands within the prism (drain/cut_sheet.h), and the
// two rims are joined along the prism's sides. All corners away from it stay as they are; what is cut out of
// M is handed back beside the mesh, and together with the mesh's outer triangles it is M again.
//
// Guarantees, where the merged mesh had them: every edge has exactly two triangles in opposite directions, no
// triangle has two equal corners as floats, and no pair of triangles cuts each other that did not before.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "worker/drain/opening.h"
#include "worker/mesh/triangle_mesh.h"

namespace skinframe {

// A hollow that no opening reaches: what fills it while printing stays.
struct SealedVoid {
  double volume_mm3 = 0;
  Eigen::Vector3d centre_mm = Eigen::Vector3d::Zero();
};

struct OpenedMesh {
  TriangleMesh mesh;                // M's own triangles first, cut at the holes; coordinates are exact floats
  std::size_t outer_triangles = 0;  // of them
  TriangleMesh lids;                // what is cut out of M
  double volume_mm3 = 0;
  std::vector<Opening> openings;  // that are cut
  std::vector<Opening> uncut;     // where the sheets are not such as can be cut
};

// merged: closed, its first outer_triangles M's, the rest the cavity's, reversed (printable.h).
OpenedMesh open_holes(const TriangleMesh& merged, std::size_t outer_triangles,
                      const std::vector<Opening>& openings);

// The largest first.
std::vector<SealedVoid> find_sealed_voids(const TriangleMesh& closed_mesh);

// One closed plug for each opening: M's own surface within radius_mm - clearance_mm of the axis, and the same
// thickness_mm further in. Put in from outside, glued. Openings whose plug cannot be cut from M have none;
// `capped` counts the others.
TriangleMesh make_caps(const TriangleMesh& m, const std::vector<Opening>& openings, double thickness_mm,
                       double clearance_mm, int* capped);

}  // namespace skinframe
