// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/session.h"

#include <algorithm>

namespace skinframe {

ProgramOutcome Session::solve(const FrameProblem& problem, ProgramRequest request,
                              const std::vector<double>& start_mm2,
                              std::function<bool(const ProgramVector&, const KktError&)> good_enough) {
  const int struts = static_cast<int>(problem.frame.struts.size());
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
  if (good_enough) options.good_enough = std::move(good_enough);
  options.restore_equilibrium = [&](ProgramVector& point) { scaled.restore_equilibrium(point); };

  const InteriorPointResult result = solve_program(scaled.program(), scaled.start(), options);
  iterations_ += result.iterations;
  return {result.end, scaled.areas_mm2(result.point), scaled.positions_mm(result.point), result.point.elastic,
          result.error.worst()};
}

}  // namespace skinframe
