// SPDX-License-Identifier: GPL-3.0-or-later
// The body as a solid, by quadratic tetrahedra cut from the distance field: displacements and pinches only.
//
// Held is the surface within kContactToleranceMm of the plate, or up to where the shells are held where their
// contact lies higher by more than the skin, as above a tip that is skin alone. Tetrahedra there are of half
// the foot's width (foot.h) and grow from there; where their nodes below have less area about them than the
// body has there, nodes next above are held until they have as much.
#pragma once

#include "worker/stress/tet_mesh.h"
#include "worker/verify/pinch.h"
#include "worker/verify/verify.h"

namespace skinframe {

inline constexpr std::size_t kMostSolidTetrahedra = 16000;

struct StandingSolid {
  TetMesh mesh;  // of one piece
  double held_below_mm = 0, foot_area_mm2 = 0;
};

struct SolidSpacing {
  double body_mm = 0;                                  // away from the foot
  double across_foot = 2;                              // to the foot's width
  std::size_t most_tetrahedra = kMostSolidTetrahedra;  // with a finer foot; coarser there beyond
};

// Errors: those of the tetrahedra.
Result<StandingSolid> standing_solid(const Skin& skin, const TriangleMesh& body, double held_top_mm,
                                     const SolidSpacing& spacing, const RunContext& context);

// Errors: those of the tetrahedra and their solution.
Result<DesignFigures> assess_solid(const VerifyInput& input, const FineSkin& fine,
                                   const std::vector<PinchSite>& pinches, const RunContext& context);

}  // namespace skinframe
