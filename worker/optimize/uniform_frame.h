// SPDX-License-Identifier: GPL-3.0-or-later
// The baseline "one radius for all": the smallest r such that every strut at clamp(r, its bounds) keeps
// constraints (1)-(6). Nothing is removed, nothing moves. `feasible` also asks for balance (8), which no
// uniform radius looks after.
#pragma once

#include "worker/optimize/baseline_frame.h"
#include "worker/run/result.h"

namespace skinframe {

struct UniformOptions {
  double relative_tolerance = 1e-6;     // of r, at the end of the bisection; (0, 1)
  double feasibility_tolerance = 1e-6;  // as in OptimizeOptions
};

// Errors: invalid problem.
Result<BaselineFrame> uniform_frame(const FrameProblem& problem, const UniformOptions& options = {});

}  // namespace skinframe
