// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/session.h"

#include <algorithm>
#include <chrono>

namespace skinframe {
namespace {

// Where duals are known the first barrier may be small.
constexpr double kWarmBarrier = 1e-3;

// Errors at which the volume less the gap of complementarity bounds the optimum well enough to give up.
constexpr double kNearPrimal = 1e-3, kNearDual = 1e-2;

}  // namespace

ProgramOutcome Session::solve(const FrameProblem& problem, ProgramRequest request,
                              const std::vector<double>& start_mm2,
                              std::function<bool(const ProgramVector&, const KktError&)> good_enough) {
  const int struts = static_cast<int>(problem.frame.struts.size());
  const bool least_volume = request.elastic == ElasticScope::kNone && !request.volume_cap_mm3;
  if (least_volume && request.warm.empty() && state_.offered.fits(problem.frame.nodes_mm.size())) {
    request.warm = state_.offered;
    request.initial_barrier = std::min(request.initial_barrier, kWarmBarrier);
  }
  InteriorPointOptions options;
  options.initial_barrier = request.initial_barrier;
  options.tolerance = request.tolerance_factor * options_.kkt_tolerance;
  options.max_iterations = options_.max_interior_point_iterations;
  if (request.max_iterations)
    options.max_iterations = std::min(options.max_iterations, *request.max_iterations);
  const ScaledProgram scaled(problem, std::move(request), start_mm2);
  options.each = [&](const IterationRecord& record) {
    if (context_.report)
      context_.report(
          {stage_, stage_iteration_++, scaled.volume_mm3(record.volume), record.error.primal, struts});
    if (options_.log) {
      if (record.iteration == 0) options_.log(iteration_log_header());
      options_.log(iteration_log_line(record));
    }
    return !context_.cancelled();
  };
  options.cancelled = [&] { return context_.cancelled(); };
  options.team = team_;
  if (least_volume && state_.most_mm3)
    options.good_enough = [&](const ProgramVector& point, const KktError& error) {
      return error.primal <= kNearPrimal && error.dual <= kNearDual &&
             scaled.volume_mm3(program_volume(scaled.program(), point) - scaled.gap(error)) >
                 *state_.most_mm3;
    };
  if (good_enough) options.good_enough = std::move(good_enough);
  options.start_duals = scaled.start_duals();
  options.restore_equilibrium = [&](ProgramVector& point) { scaled.restore_equilibrium(point); };

  const auto began = std::chrono::steady_clock::now();
  const InteriorPointResult result = solve_program(scaled.program(), scaled.start(), options);
  state_.effort.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  state_.effort.iterations += result.iterations;
  state_.effort.factorisations += result.factorisations;
  ProgramOutcome outcome{
      result.end,           scaled.areas_mm2(result.point), scaled.positions_mm(result.point),
      result.point.elastic, result.error.worst(),           {}};
  if (least_volume && outcome.converged())
    state_.latest = outcome.warm = scaled.warm_start(result.point, result.duals);
  return outcome;
}

}  // namespace skinframe
