// SPDX-License-Identifier: GPL-3.0-or-later
// Warm start: what of an earlier job's frame serves this one, and the optimiser's way from there.
//
//   sampled frame   taken over when it stands on the same M1, was asked for with the same counts and seed,
//   and is
//                   still fine enough for the finger rule; sampling is then left out
//   reduced frame   its struts, node positions and radii are where the optimiser starts
//
// Guarantees:
//  1. What comes out keeps every constraint of this job: it is sized and evaluated for it like any other
//  frame.
//  2. Infeasible is said of the sampled frame, sized from nothing, and so is the lower bound: as in a cold
//  run.
//  3. Where the struts may vanish and the nodes stand still no frame has less volume than a proven bound
//     (optimize/volume_lower_bound.h). The reduced frame's result is taken only when it stands at most
//     kWarmTolerance further above this job's bound than the earlier job's result stood above its own;
//     otherwise the cold way is gone as well, and the smaller result is taken. So only an accepted one can be
//     larger than a cold run's. By how much is measured, not proven, since both are local optima:
//     0.3 % and 0.1 % larger on the hanging ball with another load, 1.3 % on a small egg; and smaller where
//     the nodes that follow the new loads' stress happen to serve less well.
//  4. Same spec, same earlier files: same result.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "worker/pipeline/initial_frame.h"
#include "worker/pipeline/request.h"
#include "worker/report/report.h"

namespace skinframe {

// More skin nodes than that are sampled anew, relative: what the finger rule would ask for of the new limits
// and material, against what it asked for then.
inline constexpr double kFinerByAtMost = 0.05;
inline constexpr double kWarmTolerance = 0.01;

// The earlier job's frame that fits, the same printer's first. None: report->warm_start->detail says why.
// report->warm_start is there.
std::optional<InitialFrame> find_earlier_frame(const EarlierJob& warm_start, const std::string& printer,
                                               const std::string& key, const Skin& skin,
                                               const FrameOptions& options, WarmStartReport* report);

// optimize_frame(problem, options) from the earlier job's reduced frame, which is there. `reduced_problem` is
// this job's problem posed on that frame; result.initial and result.size are of `problem`. report->reused
// tells what served.
Result<OptimizeResult> optimize_from(const InitialFrame& earlier, const FrameProblem& reduced_problem,
                                     const FrameProblem& problem, const OptimizeOptions& options,
                                     WarmStartReport* report, RunContext& context);

}  // namespace skinframe
