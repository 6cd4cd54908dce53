// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/interior_point.h"

#include <algorithm>
#include <optional>

#include "worker/optimize/barrier_update.h"
#include "worker/optimize/kkt_system.h"
#include "worker/optimize/line_search.h"
#include "worker/optimize/regularisation.h"

namespace skinframe {
namespace {

using Eigen::VectorXd;

constexpr double kSmallestBarrierShare = 1.0 / 11;  // of the tolerance: mu itself is an error at the end
constexpr double kDualSpread = 1e10;                // duals stay within mu / s divided and multiplied by this
constexpr double kRestoredSpread = 1e4;
constexpr int kMostRestorations = 30;
constexpr double kRestoredMultiplierStep = 0.5;

double longest(const VectorXd& values, const VectorXd& step, double fraction) {
  double length = 1;
  for (Eigen::Index i = 0; i < values.size(); ++i)
    if (step[i] < 0) length = std::min(length, -fraction * values[i] / step[i]);
  return length;
}

void keep_duals_near_path(Iterate& it, double barrier, double spread) {
  it.duals =
      it.duals.array().min(spread * barrier / it.slacks.array()).max(barrier / (spread * it.slacks.array()));
}

class InteriorPoint {
 public:
  InteriorPoint(const FrameProgram& program, ProgramVector start, const InteriorPointOptions& options)
      : program_(program),
        options_(options),
        layout_(program),
        kkt_(program_, layout_, options.team, options.cancelled),
        line_search_(program_, layout_),
        barrier_(options.initial_barrier, kSmallestBarrierShare * options.tolerance),
        iterate_(start_iterate(program_, layout_, std::move(start), options.initial_barrier,
                               options.start_duals)) {}

  InteriorPointResult run() {
    for (int iteration = 0; iteration < options_.max_iterations; ++iteration) {
      const KktError error = kkt_error(program_, layout_, iterate_, 0);
      if (!options_.each(record(iteration, error))) return result(InteriorPointEnd::kCancelled, iteration);
      keep_best(iteration, error);
      if (const auto end =
              converged({error.worst(), best_error_, iteration - best_at_}, options_.tolerance)) {
        if (*end == InteriorPointEnd::kAcceptable) iterate_ = *best_;
        return result(*end, iteration);
      }
      if (options_.good_enough(iterate_.point, error))
        return result(InteriorPointEnd::kGoodEnough, iteration);

      update_barrier();
      if (!factorise())
        return result(options_.cancelled() ? InteriorPointEnd::kCancelled : InteriorPointEnd::kStuck,
                      iteration);
      const NewtonStep step = newton_step();
      if (auto accepted = line_search_.search(iterate_, step, barrier_.value()))
        move_to(std::move(*accepted), step);
      else if (!restore(step))
        return result(InteriorPointEnd::kStuck, iteration);
    }
    return result(InteriorPointEnd::kIterationLimit, options_.max_iterations);
  }

 private:
  void keep_best(int iteration, const KktError& error) {
    if (best_ && !(error.worst() < best_error_)) return;
    best_ = iterate_;
    best_error_ = error.worst();
    best_at_ = iteration;
  }

  void update_barrier() {
    while (barrier_.solved_well(kkt_error(program_, layout_, iterate_, barrier_.value()).worst())) {
      barrier_.decrease();
      line_search_.reset();
    }
  }

  bool factorise() {
    regularisation_ = inertia_.first();
    for (factorisations_ = 1;; ++factorisations_) {
      kkt_.assemble(iterate_, regularisation_);
      ++all_factorisations_;
      if (kkt_.factorise()) break;
      if (options_.cancelled()) return false;
      const auto stronger = inertia_.next();
      if (!stronger) return false;
      regularisation_ = *stronger;
    }
    inertia_.accept();
    return true;
  }

  NewtonStep newton_step() {
    const double barrier = barrier_.value();
    NewtonStep step = complete_step(program_, layout_, iterate_, barrier, kkt_.solve(iterate_, barrier));
    step.primal_length = longest(iterate_.slacks, step.slacks, barrier_.fraction_to_boundary());
    step.dual_length = longest(iterate_.duals, step.duals, barrier_.fraction_to_boundary());
    return step;
  }

  void move_to(LineSearch::Accepted accepted, const NewtonStep& step) {
    iterate_ = std::move(accepted.iterate);
    taken_ = {accepted.length, step.dual_length, accepted.halvings};
    iterate_.duals += step.dual_length * step.duals;
    keep_duals_near_path(iterate_, barrier_.value(), kDualSpread);
  }

  // No trial was acceptable: put D into equilibrium, let slacks follow, and keep half of the multipliers'
  // step.
  bool restore(const NewtonStep& step) {
    if (++restorations_ > kMostRestorations) return false;
    taken_ = {};
    options_.restore_equilibrium(iterate_.point);
    const VectorXd c = inequalities(program_, layout_, iterate_.point);
    const double floor = std::max(1e-3 * barrier_.value(), 1e-8);
    for (int i = layout_.displacement; i < layout_.count; ++i) iterate_.slacks[i] = std::max(-c[i], floor);
    keep_duals_near_path(iterate_, barrier_.value(), kRestoredSpread);
    for (int k = 0; k < program_.case_count(); ++k)
      iterate_.point.multipliers[k] += kRestoredMultiplierStep * step.point.multipliers[k];
    line_search_.reset();
    inertia_.distrust();
    return true;
  }

  IterationRecord record(int iteration, const KktError& error) const {
    return {iteration,
            barrier_.value(),
            objective(program_, iterate_.point),
            program_volume(program_, iterate_.point),
            error,
            regularisation_.primal,
            taken_.primal_length,
            taken_.dual_length,
            taken_.halvings,
            factorisations_};
  }

  InteriorPointResult result(InteriorPointEnd end, int iterations) const {
    return {end,        iterate_.point,     iterate_.duals, kkt_error(program_, layout_, iterate_, 0),
            iterations, all_factorisations_};
  }

  const FrameProgram& program_;
  const InteriorPointOptions& options_;
  InequalityLayout layout_;
  KktSystem kkt_;
  LineSearch line_search_;
  BarrierUpdate barrier_;
  InertiaCorrection inertia_;
  Regularisation regularisation_;
  Iterate iterate_;
  std::optional<Iterate> best_;  // of the least error at mu = 0
  double best_error_ = 0;
  int best_at_ = 0;
  int restorations_ = 0;
  int factorisations_ = 0;  // of the last step
  int all_factorisations_ = 0;
  struct Taken {
    double primal_length = 0, dual_length = 0;
    int halvings = 0;
  } taken_;
};

}  // namespace

InteriorPointResult solve_program(const FrameProgram& program, ProgramVector start,
                                  const InteriorPointOptions& options) {
  return InteriorPoint(program, std::move(start), options).run();
}

}  // namespace skinframe
