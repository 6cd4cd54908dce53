// SPDX-License-Identifier: GPL-3.0-or-later
// What the interior point of a relaxation moves: the saddle point, the duals of the bounds on A, the slacks
// of the terms. A step is one of the same shape.
#pragma once

#include "worker/optimize/relaxation_values.h"

namespace skinframe {

struct RelaxationIterate {
  SaddlePoint point;
  Eigen::VectorXd below_dual, above_dual;     // one a strut; zero where the area is given
  Eigen::VectorXd slacks;                     // of the terms: excess + slack = excess_bound
  double excess_bound = 0, excess_slack = 0;  // of the least excess: its value, and 1 - sum of multipliers
};

// The mean of all products that the barrier drives to zero. `bounded_excess`: the least excess is looked for.
double mean_product(const Relaxation& relaxation, const RelaxationIterate& at, bool bounded_excess);

// The same after `length` of a step.
double mean_product_after(const Relaxation& relaxation, const RelaxationIterate& at,
                          const RelaxationIterate& step, double length, bool bounded_excess);

// The longest step that keeps every positive quantity at (1 - share) of itself, at most 1.
double step_length(const Relaxation& relaxation, const RelaxationIterate& at, const RelaxationIterate& step,
                   double share, bool bounded_excess);

// `values` are those at `at` before.
void advance(const Relaxation& relaxation, const RelaxationValues& values, const RelaxationIterate& step,
             double length, RelaxationIterate* at);

}  // namespace skinframe
