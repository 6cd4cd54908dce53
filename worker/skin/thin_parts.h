// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of M that are thinner than two skins (Wang et al. 2013, section 4.6): they have no M1, take no
// internal node and are printed solid; the skin's volume holds them in full.
//
// A point of M is thin when the wall at its nearest surface point is: the inward normal that runs from there
// through the point leaves M again within 2 h_S.
//
// Kinds: with A the surface of a part, t the mean length of the inward normals through it and V its volume,
// A t / (2 V) is 1 for a sheet and 2 for a round or square limb; the border is at 1.5.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "worker/mesh/triangle_mesh.h"
#include "worker/run/run_context.h"
#include "worker/skin/distance_field.h"

namespace skinframe {

enum class ThinKind { kSheet, kLimb };
inline const char* to_string(ThinKind kind) { return kind == ThinKind::kSheet ? "sheet" : "limb"; }

struct ThinRegion {
  ThinKind kind = ThinKind::kSheet;
  double volume_mm3 = 0.0;
  double mean_thickness_mm = 0.0;                       // of the inward normals that leave M within 2 h_S
  Eigen::Vector3d centre_mm = Eigen::Vector3d::Zero();  // of its volume
};

struct ThinParts {
  double volume_mm3 = 0.0;  // of all regions, also of those that are too many or too small for the list
  double fraction = 0.0;    // of the volume of M, 0..1
  int region_count = 0;
  std::vector<ThinRegion> regions;  // of at least h_S^3, the largest first, kMostThinRegions at most
};
inline constexpr std::size_t kMostThinRegions = 64;

// The field finds where to look; the triangles of M decide, by exact rays and distances from one random point
// in each cell of a lattice of h_S / 4, coarser where thin parts are large. The volume is right to about 1 %
// from 100 h_S^3 on. A body with no wall near 2 h_S costs one pass over its surface.
ThinParts find_thin_parts(const TriangleMesh& closed_mesh, const DistanceField& field, double thickness_mm,
                          const RunContext& context);

}  // namespace skinframe
