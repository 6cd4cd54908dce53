// SPDX-License-Identifier: GPL-3.0-or-later
// The primal-dual interior point for frame programs (Nocedal and Wright 2006, chapter 19), in roles:
// kkt_system (the step), regularisation (its inertia), line_search (its length), barrier_update (mu),
// convergence_test (the end), iteration_log (what happened).
#pragma once

#include <functional>
#include <memory>

#include "worker/optimize/convergence_test.h"
#include "worker/optimize/iterate.h"
#include "worker/optimize/iteration_log.h"
#include "worker/optimize/thread_team.h"

namespace skinframe {

struct InteriorPointOptions {
  double tolerance = 1e-7;  // stops when the scaled error at mu = 0 is <= this
  int max_iterations = 300;
  double initial_barrier = 0.1;
  Eigen::VectorXd start_duals;  // of each inequality, 0: not known; empty: none is. See start_iterate.
  // Called once an iteration; false: stop, cancelled.
  std::function<bool(const IterationRecord&)> each = [](const IterationRecord&) { return true; };
  // Asked many times during a factorisation; true: stop, cancelled.
  std::function<bool()> cancelled = [] { return false; };
  std::shared_ptr<ThreadTeam> team;  // null: one thread. The result is the same with any.
  // Called once an iteration; true: this point serves, stop.
  std::function<bool(const ProgramVector&, const KktError&)> good_enough = [](const auto&, const auto&) {
    return false;
  };
  // Puts the displacements into equilibrium with areas and positions, for when the line search is stuck.
  std::function<void(ProgramVector&)> restore_equilibrium = [](ProgramVector&) {};
};

struct InteriorPointResult {
  InteriorPointEnd end = InteriorPointEnd::kStuck;
  ProgramVector point;    // the last iterate; the best one when acceptable
  Eigen::VectorXd duals;  // of its inequalities
  KktError error;
  int iterations = 0;
  int factorisations = 0;
};

// Bounds with lower < upper must leave room: the start is pushed inside them.
InteriorPointResult solve_program(const FrameProgram& program, ProgramVector start,
                                  const InteriorPointOptions& options);

}  // namespace skinframe
