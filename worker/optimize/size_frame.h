// SPDX-License-Identifier: GPL-3.0-or-later
// SizeOpt (15): the areas of least volume for given nodes and struts.
//
//   presolve   lower bounds feasible: they are the global optimum (one linear solve)
//   start      the smallest feasible uniform radius, else the least violation reachable
//   solve      the interior point over the critical load case; cases it violates join until none does
//
// Where no uniform radius is feasible a proof of infeasibility is tried first, which takes milliseconds
// (infeasibility_certificate.h); what follows it is the sizing's effort.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "worker/mechanics/evaluation.h"
#include "worker/mechanics/frame_problem.h"
#include "worker/optimize/design.h"
#include "worker/optimize/infeasibility_certificate.h"
#include "worker/optimize/session.h"

namespace skinframe {

enum class SizingEffort {
  kVerdict,        // infeasible: stop at its proof
  kBestReachable,  // infeasible: the least violation all the same, proven or not
};

struct SizedFrame {
  Termination reason = Termination::kInfeasible;
  bool cancelled = false;
  std::vector<double> areas_mm2;
  Evaluation evaluation;
  double kkt_error = 0;
  std::optional<double> lower_bound_mm3;
  std::string violated_constraint;                      // when infeasible
  std::optional<InfeasibilityCertificate> certificate;  // when infeasible and proven
  std::string detail;

  bool feasible() const { return !cancelled && reason != Termination::kInfeasible; }
  double volume_mm3() const { return evaluation.frame_volume_mm3; }
};

// `hint_mm2`: areas near the optimum, one a strut, or empty. Cancellation is in the result.
SizedFrame size_frame(const FrameProblem& problem, const std::vector<double>& hint_mm2, Session& session,
                      SizingEffort effort = SizingEffort::kVerdict);

// The design takes the areas of its sizing, and how that ended.
void take_sizing(Design& design, SizedFrame sized);

// Every constraint holds within the feasibility tolerance.
bool is_feasible(const Evaluation& evaluation, const OptimizeOptions& options);

}  // namespace skinframe
