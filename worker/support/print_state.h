// SPDX-License-Identifier: GPL-3.0-or-later
// The frame as it stands on the base plane at the end of printing, supports in place, under self weight
// alone: constraint (22) of Wang et al. 2013, section 4.5, in the paper's model.
//
// (22) bounds the vertical deformation of each strut. Taken for every strut under every load it cannot hold:
// a hanging or a level strut has to give way to carry anything. It is read here as |d_az - d_bz| <= epsilon
// under self weight while printing, level struts exempt. Supports start at their least radii, where the
// frame's own optimum is kept; where (22) does not hold they grow together. The frame has to keep the job's
// loads without them, so its least volume plus theirs at least radii bounds every SizeOpt over both from
// below: where (22) holds at once, this is its optimum.
#pragma once

#include "worker/mechanics/frame_problem.h"
#include "worker/run/run_context.h"
#include "worker/support/support_plan.h"

namespace skinframe {

struct PrintState {
  double worst_deformation_mm = 0;  // over all struts and supports but level ones
  std::optional<double> limit_mm;   // epsilon
  bool holds() const { return !limit_mm || worst_deformation_mm <= *limit_mm * (1 + 1e-6); }
};

inline constexpr double kLevelDegrees = 85;  // from the vertical: flatter struts are exempt
inline constexpr int kMostGrowths = 8;
inline constexpr double kGrowth = 1.25;  // of the radii, each time

// The structure whose deformation that is: every strut divided at its nodes, the supports, and for each node
// that stands in the skin struts of radius `tie_radius_mm` to the three skin nodes nearest to it, for the
// skin there. Contact nodes and feet on the plate are held in all axes.
FrameProblem print_problem(const FrameProblem& problem, const std::vector<double>& radii_mm,
                           const SupportPlan& plan, double tie_radius_mm, std::vector<double>* all_radii_mm);

// Makes the supports of the plan thick enough, and tells the deformation that is left.
PrintState size_supports(const FrameProblem& problem, const std::vector<double>& radii_mm,
                         double tie_radius_mm, SupportPlan& plan);

}  // namespace skinframe
