// SPDX-License-Identifier: GPL-3.0-or-later
// The saddle point of a convex relaxation by a primal-dual interior point (Nocedal and Wright 2006, chapter
// 19), with Mehrotra's choice of the barrier. Roles: what the problem is worth at a point
// (relaxation_values.h), the step (relaxation_system.h), how far it goes (relaxation_iterate.h).
//
// Any iterate's fields and multipliers prove something (see dual_proof.h): nothing depends on convergence but
// how much.
#pragma once

#include <functional>

#include "worker/optimize/convex_relaxation.h"

namespace skinframe {

struct RelaxationOptions {
  // Minimise the greatest excess of the terms, and not the cost: their multipliers then sum to at most one.
  bool least_excess = false;
  int max_iterations = 60;
  double tolerance = 1e-7;  // scaled residuals and complementarity, nondimensional
  // Called with each iterate; true: it serves, stop.
  std::function<bool(const SaddlePoint&)> each = [](const SaddlePoint&) { return false; };
};

struct RelaxationOutcome {
  int iterations = 0;
  bool converged = false;
  // least_excess: some areas keep every term, to first order; nothing can be proven.
  bool feasible = false;
};

// From areas within the bounds and fields y (not w) that fit them: the displacements there.
RelaxationOutcome solve_relaxation(const Relaxation& relaxation, const Eigen::VectorXd& start_areas,
                                   const Eigen::VectorXd& start_displacements,
                                   const RelaxationOptions& options);

}  // namespace skinframe
