// SPDX-License-Identifier: GPL-3.0-or-later
// The usual way to size a frame, as a baseline: areas are the only variables, displacements follow from one
// factorisation an evaluation, gradients from an adjoint solve (Svanberg 2002's method of moving asymptotes,
// NLopt's LD_MMA). Its limit (6) is one number a load case, the p-norm of |d_i|^2 / epsilon^2 over the nodes
// with p = 40, which lies above the largest: what it hands over keeps (6) with some room, and it looks at
// displacements only. That room is the price of one constraint for thousands.
#pragma once

#include <string>
#include <vector>

#include "worker/mechanics/frame_problem.h"

namespace skinframe::bench {

bool has_nlopt();

struct NestedMma {
  std::vector<double> areas_mm2;
  int evaluations = 0;  // factorisations
  std::string ending;   // "converged", "time limit", "evaluation limit", or NLopt's words
};

// From the smallest uniform radius that keeps the limits. Needs a displacement limit. Without NLopt: its
// start, and says so.
NestedMma nested_mma(const FrameProblem& problem, double max_seconds);

}  // namespace skinframe::bench
