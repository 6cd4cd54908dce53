// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/optimise/methods.h"

#include <sys/resource.h>

#include <chrono>

#include "tests/bench/optimise/nested_mma.h"
#include "worker/optimize/greedy_cleaning.h"
#include "worker/optimize/optimize_frame.h"
#include "worker/optimize/uniform_frame.h"

namespace skinframe::bench {
namespace {

class Clock {
 public:
  void stop(Row& row) const {
    row.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_).count();
    row.cpu_seconds = cpu_now() - cpu_;
  }

 private:
  static double cpu_now() {
    rusage use{};
    getrusage(RUSAGE_SELF, &use);
    const auto seconds = [](const timeval& t) {
      return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return seconds(use.ru_utime) + seconds(use.ru_stime);
  }
  std::chrono::steady_clock::time_point wall_ = std::chrono::steady_clock::now();
  double cpu_ = cpu_now();
};

RunContext context_of(const MethodLimits& limits) {
  RunContext context;
  context.threads = limits.threads;
  return context;
}

void take_evaluation(const Evaluation& evaluation, Row& row) {
  row.volume_mm3 = evaluation.frame_volume_mm3;
  row.worst_ratio = utilisation(evaluation);
}

Result<Row> run_optimiser(const FrameProblem& problem, const OptimizeOptions& options,
                          const MethodLimits& limits) {
  Row row;
  RunContext context = context_of(limits);
  const Clock clock;
  const auto result = optimize_frame(problem, options, context);
  clock.stop(row);
  if (!result) return result.error();
  row.status = to_string(result->reason);
  take_evaluation(result->evaluation, row);
  row.iterations = result->interior_point_iterations;
  row.factorisations = result->factorisations;
  row.solve_seconds = result->interior_point_seconds;
  row.lower_bound_mm3 = result->lower_bound_mm3;
  row.relaxed_gap = result->relaxed_gap;
  row.size_volume_mm3 = result->size.volume_mm3;
  row.struts_left = result->geometry.struts;
  row.kkt_error = result->kkt_residual;
  for (const StageRecord& s : {result->initial, result->size, result->topology, result->geometry})
    row.stages.push_back({s.nodes, s.struts, s.volume_mm3});
  return row;
}

Result<Row> run_size(const FrameProblem& problem, const MethodLimits& limits) {
  OptimizeOptions options;
  options.relaxed = options.topology = options.geometry = false;
  return run_optimiser(problem, options, limits);
}

Result<Row> run_loop(const FrameProblem& problem, OptimizeOptions::Order order, const MethodLimits& limits) {
  OptimizeOptions options;
  options.order = order;
  return run_optimiser(problem, options, limits);
}

Result<Row> run_baseline(const Clock& clock, const Result<BaselineFrame>& frame) {
  Row row;
  clock.stop(row);
  if (!frame) return frame.error();
  row.status = frame->feasible ? "feasible" : "infeasible";
  take_evaluation(frame->evaluation, row);
  row.iterations = frame->interior_point_iterations > 0 ? frame->interior_point_iterations : frame->rounds;
  if (frame->factorisations > 0) row.factorisations = frame->factorisations;
  row.struts_left = static_cast<int>(frame->problem.frame.struts.size());
  return row;
}

Result<Row> run_uniform(const FrameProblem& problem) {
  const Clock clock;
  return run_baseline(clock, uniform_frame(problem));
}

Result<Row> run_greedy(const FrameProblem& problem, const MethodLimits& limits) {
  RunContext context = context_of(limits);
  const Clock clock;
  return run_baseline(clock, greedy_cleaning(problem, {}, context));
}

Result<Row> run_mma(const FrameProblem& problem, const MethodLimits& limits) {
  if (!has_nlopt()) return unsupported("NLopt was absent when this was built (libnlopt-dev)");
  Row row;
  const Clock clock;
  const NestedMma nested = nested_mma(problem, limits.max_seconds);
  clock.stop(row);
  const Evaluation evaluation = evaluate(problem, radii_of(nested.areas_mm2));
  row.status = nested.ending;
  take_evaluation(evaluation, row);
  row.iterations = row.factorisations = nested.evaluations;
  row.struts_left = static_cast<int>(problem.frame.struts.size());
  return row;
}

}  // namespace

std::vector<std::string> method_names() { return {"size", "tight", "paper", "greedy", "uniform", "mma"}; }

Result<Row> run_method(const std::string& method, const FrameProblem& problem, const MethodLimits& limits) {
  if (method == "size") return run_size(problem, limits);
  if (method == "tight") return run_loop(problem, OptimizeOptions::Order::kTight, limits);
  if (method == "paper") return run_loop(problem, OptimizeOptions::Order::kPaper, limits);
  if (method == "uniform") return run_uniform(problem);
  if (method == "greedy") return run_greedy(problem, limits);
  if (method == "mma") return run_mma(problem, limits);
  return invalid_input("there is no method " + method);
}

}  // namespace skinframe::bench
