// SPDX-License-Identifier: GPL-3.0-or-later
// The baseline of section 5.2, figure 12: topology by a threshold on the radius. SizeOpt; then, round after
// round, the thinnest removable struts among those that stand at their lower bound go, with what no longer
// serves, and SizeOpt runs again. A round whose frame is infeasible or larger than the one before is undone
// and tried with half as many struts; the cleaning ends when not even one more strut goes.
//
// Nothing but the radius is asked: that a thin strut may matter and a thick one may not is what TopOpt knows.
#pragma once

#include "worker/optimize/baseline_frame.h"
#include "worker/optimize/optimize_frame.h"

namespace skinframe {

struct GreedyOptions {
  // A removable strut is thin when r <= radius_threshold * the radius of its lower bound; >= 1.
  double radius_threshold = 1.01;
  double largest_share = 1;  // of the thin struts that go in one round at most, (0, 1]
  int max_rounds = 40;       // sizings after the first, > 0
  OptimizeOptions optimize;  // tolerances of the sizings; its stages are not read
};

// Errors: invalid problem or options, cancelled, internal (a library gave up).
Result<BaselineFrame> greedy_cleaning(const FrameProblem& problem, const GreedyOptions& options,
                                      RunContext& context);

}  // namespace skinframe
