// SPDX-License-Identifier: GPL-3.0-or-later
// Verifies a result by the valid model (shell_models.h) and compares it with what a user would ask for: a
// uniform hollow of the same printed mass on the same mesh, the skin alone, and the solid.
//
// The skin triangulation is divided until the work of each load is known to kMeshTolerance by mesh_error_of
// (of what moves less than the displacement limit, to that share of the limit), or until the next level would
// have more than kMostFineNodes nodes; that estimate is reported, and told in words where it is larger
// (mesh_words). Parts of the body that are thinner than two skins are solid in print and not in the model:
// their stiffness is left out. So are supports of the print.
#pragma once

#include <functional>

#include "worker/mechanics/frame_problem.h"
#include "worker/run/run_context.h"
#include "worker/skin/build_skin.h"
#include "worker/stress/stress_map.h"
#include "worker/verify/verification.h"

namespace skinframe {

inline constexpr std::size_t kMostFineNodes = 10000;
inline constexpr int kSolidTetrahedra =
    8000;  // quadratic ones, aimed at; those cut by the surface come on top

struct VerifyInput {
  const FrameProblem& problem;  // the frame as printed
  const std::vector<double>& radii_mm;
  const Skin& skin;
  const TriangleMesh& body;  // M
  double solid_volume_mm3 = 0, printed_volume_mm3 = 0;
  // The job's loads on a skin triangulation, the self-weight case included.
  std::function<Result<std::vector<LoadCase>>(const Frame&)> place_loads;
  std::vector<StressLoad> loads;  // the same by their points, for the solid
  bool compare_solid = true;
};

// Errors: where the valid model has no answer (it falls apart, forces do not balance), told in words;
// kCancelled.
Result<Verification> verify(const VerifyInput& input, const RunContext& context);

}  // namespace skinframe
