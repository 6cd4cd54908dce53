// SPDX-License-Identifier: GPL-3.0-or-later
// The skin: what lies between the input surface M and its inner offset M1 at the skin thickness h_S = 2 eta
// (Wang et al. 2013, section 4.1). M1 is the iso-surface at -h_S of the signed distance to M; where M is
// thinner than 2 h_S there is no M1 and the part is solid, and M1 may fall into several pieces.
//
// With fine detail smoothed (section 4.6, fine_detail.h) M1 is what lies deeper than h_S below both M and the
// smooth copy, and what lies between the two counts as skin.
//
// Example: auto skin = build_skin(solid, {.thickness_mm = 1.0}, context);
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "worker/mesh/triangle_mesh.h"
#include "worker/run/run_context.h"
#include "worker/skin/distance_field.h"
#include "worker/skin/fine_detail.h"
#include "worker/skin/sharp_edges.h"
#include "worker/skin/thin_parts.h"

namespace skinframe {

class Solid;

struct SkinOptions {
  double thickness_mm = 1.0;  // h_S, > 0
  std::optional<double>
      voxel_mm;  // fine grid, in [h_S / 20, h_S]; default 0.3 h_S = 0.6 eta, coarser on large bodies
  Smooth smooth = Smooth::kOff;
  Status validate() const;
};

// What became of detail finer than the skin.
struct Smoothing {
  FineDetail detail;  // of M, as measured
  bool applied = false;
  double added_skin_mm3 = 0.0;  // deeper than h_S below M, but not below the copy; 0 where not applied
  TriangleMesh copy;            // to take the larger distance of; empty where not applied
};

struct Skin {
  double thickness_mm = 0.0;
  double voxel_mm = 0.0;
  double plate_z_mm = 0.0;  // lowest z of M
  BoundingBox body_box_mm;  // of M
  // Of M; where detail is smoothed, of the part of the smooth copy inside M: never nearer to 0 inside M than
  // M's.
  DistanceField field;
  std::optional<Smoothing> smoothing;  // none where it was off
  // M1 from the coarse grid (about 1 mm at 200 mm), closed and outward, for sampling. Empty where all is
  // thin.
  TriangleMesh inner_surface;
  std::vector<SharpCurve> sharp_edges;  // of M1; none where detail is smoothed, for the copy has none
  double cavity_volume_mm3 = 0.0;       // of M1, from the fine grid
  double volume_mm3 = 0.0;              // M minus M1
  Eigen::Vector3d centroid_mm = Eigen::Vector3d::Zero();  // of the skin's volume
  ThinParts thin;                                         // solid parts of the skin

  // Nothing to hollow: no frame would save kLeastHollowShare of the material.
  bool is_thin_everywhere() const;
};
inline constexpr double kLeastHollowShare = 0.01;  // of the volume of M

// Errors: kInvalidInput when a grid would hold more voxels than memory is granted (the message names the
// remedy: a larger --voxel or a smaller --size), decided before any is taken; kCancelled.
Result<Skin> build_skin(const Solid& solid, const SkinOptions& options, RunContext& context);

// The same for a mesh that the caller knows to be closed and outward.
Result<Skin> build_skin(const TriangleMesh& closed_mesh, const SkinOptions& options, RunContext& context);

}  // namespace skinframe
