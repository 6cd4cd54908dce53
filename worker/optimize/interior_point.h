// SPDX-License-Identifier: GPL-3.0-or-later
// The primal-dual interior point for frame programs (Nocedal and Wright 2006, chapter 19), in roles:
// kkt_system (the step), regularisation (its inertia), line_search (its length), barrier_update (mu), iterate
// (the convergence test).
#pragma once

#include <functional>

#include "worker/optimize/iterate.h"

namespace skinframe {

struct IterationRecord {
  int iteration = 0;
  double barrier = 0;
  double objective = 0;
  double volume = 0;  // nondimensional
  KktError error;     // at mu = 0
  double regularisation = 0;
};

struct InteriorPointOptions {
  double tolerance = 1e-7;  // stops when the scaled error at mu = 0 is <= this
  int max_iterations = 300;
  double initial_barrier = 0.1;
  // Called once an iteration; false: stop, cancelled.
  std::function<bool(const IterationRecord&)> each = [](const IterationRecord&) { return true; };
  // Called once an iteration; true: this point serves, stop.
  std::function<bool(const ProgramVector&, const KktError&)> good_enough = [](const auto&, const auto&) {
    return false;
  };
  // Puts the displacements into equilibrium with areas and positions, for when the line search is stuck.
  std::function<void(ProgramVector&)> restore_equilibrium = [](ProgramVector&) {};
};

enum class InteriorPointEnd {
  kOptimal,     // error <= tolerance
  kAcceptable,  // error <= kAcceptableFactor * tolerance, and rounding lets it fall no further
  kGoodEnough,  // good_enough said so
  kIterationLimit,
  kStuck,  // neither a step nor a restoration made progress
  kCancelled,
};

struct InteriorPointResult {
  InteriorPointEnd end = InteriorPointEnd::kStuck;
  ProgramVector point;  // the last iterate; the best one when acceptable
  KktError error;
  int iterations = 0;
};

// Near the solution the reduced system is so stiff that rounding ends the descent, sooner for programs linear
// in A. When the error has not fallen for kPatience iterations, the best iterate is taken if it is within
// this factor of the tolerance.
inline constexpr double kAcceptableFactor = 100;
inline constexpr int kPatience = 8;

// Bounds with lower < upper must leave room: the start is pushed inside them.
InteriorPointResult solve_program(const FrameProgram& program, ProgramVector start,
                                  const InteriorPointOptions& options);

}  // namespace skinframe
