// SPDX-License-Identifier: GPL-3.0-or-later
// Detail of M that is finer than the skin (Wang et al. 2013, section 4.6): hair, scales, engraved lines. The
// offset of such a surface is rough, and its frame spends nodes on what the skin covers anyway; so the cavity
// is offset from a smooth copy of M that stays inside M, and what lies between the two is printed as skin.
//
// The copy: the level set's surface of M with voxels of kDetailVoxelInThicknesses h_S, which is even whatever
// the triangles of M are, faired by taubin.h, which takes away what is shorter than about four h_S; in
// rounds, each ending with a push of what stands outside of M, or nearer to it than
// kDetailMarginInThicknesses h_S, back below its nearest point. What a groove narrower than the copy's
// triangles still cuts is left to the distance field: build_skin takes the larger of the distances to M and
// to the copy. That is the distance to the part of the copy inside M, and its offset at h_S is exactly what
// is deeper than h_S below both.
#pragma once

#include "worker/mesh/triangle_mesh.h"
#include "worker/run/run_context.h"
#include "worker/skin/distance_field.h"

namespace skinframe {

enum class Smooth { kAuto, kOn, kOff };

inline constexpr double kDetailVoxelInThicknesses = 0.75;
inline constexpr double kDetailMarginInThicknesses = 0.05;

// Auto smooths where at least this share of the faired surface stands further than
// kDetailHeightInThicknesses h_S from M. Sharp edges alone are a smaller share on all but the smallest
// bodies.
inline constexpr double kDetailHeightInThicknesses = 0.15;
inline constexpr double kLeastDetailShare = 0.1;

struct FineDetail {
  double share = 0.0;   // of the surface, as above, 0..1
  double rms_mm = 0.0;  // of that distance over the whole surface
};

// The faired copy of M as fairing leaves it, partly outside; its voxels are not finer than voxel_mm.
TriangleMesh fair_surface(const TriangleMesh& closed_mesh, double thickness_mm, double voxel_mm);

// What fairing took away: how far the faired copy stands from M. field: of M.
FineDetail measure_detail(const TriangleMesh& faired, const DistanceField& field, double thickness_mm);

struct InnerCopy {
  TriangleMesh mesh;     // closed, outward
  int pushed = 0;        // corners that the last push moved
  int left_outside = 0;  // corners and middles of triangles still outside of M: cut off by the distance field
};

// `faired` brought inside M. field: of M.
InnerCopy keep_inside(const TriangleMesh& faired, const TriangleMesh& closed_mesh, const DistanceField& field,
                      double thickness_mm, const RunContext& context);

}  // namespace skinframe
