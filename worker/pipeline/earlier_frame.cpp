// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/pipeline/earlier_frame.h"

#include <fmt/format.h>

#include <cmath>

#include "worker/mechanics/equilibrium.h"
#include "worker/optimize/design.h"
#include "worker/optimize/volume_lower_bound.h"

namespace skinframe {
namespace {

double demand(const Skin& skin, double finger_edge) {
  return node_demand(skin.inner_surface,
                     edge_length_field(skin.inner_surface, finger_edge, skin.thickness_mm));
}

// Looser limits and stiffer materials let the edges be longer: the earlier frame is then finer than asked
// for.
bool still_fine_enough(const InitialFrame& earlier, const Skin& skin, const FrameOptions& options) {
  if (options.skin_nodes) return true;
  const double edge = finger_edge_mm(options.plate, skin.thickness_mm);
  if (edge >= earlier.sampled.finger_edge_mm) return true;
  return demand(skin, edge) <= (1 + kFinerByAtMost) * demand(skin, earlier.sampled.finger_edge_mm);
}

OptimizeOptions size_only(OptimizeOptions options) {
  options.relaxed = options.topology = options.geometry = false;
  return options;
}

// The least volume that is proven for the problem's nodes when struts may vanish. start_mm2: any areas.
double proven_bound_mm3(const FrameProblem& problem, std::vector<double> start_mm2,
                        const RunContext& context) {
  // Near a sized frame the critical load case is told from the others.
  const double used = utilisation(evaluate(problem, radii_of(start_mm2)));
  if (std::isfinite(used) && used > 0)
    for (double& area : start_mm2) area *= used;
  BoundRequest request;
  request.box = area_box(problem, removable_struts(problem));
  request.volume_mm3 = frame_volume_mm3(problem.frame, radii_of(start_mm2));
  request.start_mm2 = std::move(start_mm2);
  request.feasibility_tolerance = OptimizeOptions().feasibility_tolerance;
  request.cancelled = [&context] { return context.cancelled(); };
  return volume_lower_bound(problem, request).value_mm3;
}

// What the earlier job's distance from its bound lets expect of this one; 0 where a bound says nothing.
double expected_volume_mm3(const InitialFrame& earlier, const FrameProblem& problem,
                           const OptimizeResult& sized, const RunContext& context) {
  const std::vector<double> start_mm2 = areas_of(sized.radii_mm);
  const double then = proven_bound_mm3(earlier.problem, start_mm2, context);
  const double now = proven_bound_mm3(problem, start_mm2, context);
  return then > 0 ? earlier.reduced->volume_mm3 * now / then : 0;
}

void add_effort(const OptimizeResult& of, OptimizeResult* to) {
  to->interior_point_iterations += of.interior_point_iterations;
  to->factorisations += of.factorisations;
  to->interior_point_seconds += of.interior_point_seconds;
  for (const auto& [stage, seconds] : of.seconds) to->seconds[stage] += seconds;
}

}  // namespace

std::optional<InitialFrame> find_earlier_frame(const EarlierJob& warm_start, const std::string& printer,
                                               const std::string& key, const Skin& skin,
                                               const FrameOptions& options, WarmStartReport* report) {
  std::vector<std::filesystem::path> files;
  for (const auto& [name, path] : warm_start.files)
    files.insert(name == printer ? files.begin() : files.end(), path);
  if (files.empty()) report->detail = "the earlier job left no frame to start from";
  for (const auto& path : files) {
    auto earlier = read_initial_frame(path);
    if (!earlier) {
      if (report->detail.empty()) report->detail = earlier.error().message;
    } else if (earlier->key != key) {
      report->detail =
          "its frame is of another skin, node count, seed or version of the program, so a new one was "
          "sampled";
    } else if (!still_fine_enough(*earlier, skin, options)) {
      report->detail =
          "its skin is too coarse for the finger rule of the new limit and material, so a new frame "
          "was sampled";
    } else {
      report->detail.clear();
      report->reused.push_back("sampled frame");
      return std::move(earlier).value();
    }
  }
  return std::nullopt;
}

Result<OptimizeResult> optimize_from(const InitialFrame& earlier, const FrameProblem& reduced_problem,
                                     const FrameProblem& problem, const OptimizeOptions& options,
                                     WarmStartReport* report, RunContext& context) {
  report->reused = {"sampled frame"};
  report->detail.clear();
  auto sized = optimize_frame(problem, size_only(options), context);
  if (!sized || sized->reason == Termination::kInfeasible) return sized;
  OptimizeOptions warm = options;
  warm.bounds = false;  // they would be of the reduced frame
  warm.hint_radii_mm = earlier.reduced->radii_mm;
  auto tried = optimize_frame(reduced_problem, size_only(warm), context);
  if (!tried) return tried;
  OptimizeResult effort = *tried;
  const bool worth_while =
      tried->reason != Termination::kInfeasible && tried->size.volume_mm3 <= sized->size.volume_mm3;
  if (worth_while) {
    warm.hint_radii_mm = tried->radii_mm;
    tried = optimize_frame(reduced_problem, warm, context);
    if (!tried) return tried;
    add_effort(effort, &tried.value());
  }
  const bool serves = worth_while && tried->reason != Termination::kInfeasible &&
                      tried->geometry.volume_mm3 <= sized->size.volume_mm3 &&
                      (!options.accepts || options.accepts(tried->problem.frame, tried->radii_mm));
  const auto take_tried = [&] {
    OptimizeResult result = std::move(tried).value();
    result.initial = sized->initial;
    result.size = sized->size;
    result.lower_bound_mm3 = sized->lower_bound_mm3;
    result.gap = sized->gap;
    result.lower_bound_proof = sized->lower_bound_proof;
    report->reused.insert(report->reused.end(), {"reduced frame", "radii"});
    return result;
  };
  const double most =
      serves ? (1 + kWarmTolerance) * expected_volume_mm3(earlier, problem, *sized, context) : 0;
  if (serves && tried->geometry.volume_mm3 <= most) {
    OptimizeResult result = take_tried();
    add_effort(*sized, &result);
    return result;
  }

  OptimizeOptions cold = options;
  cold.hint_radii_mm = sized->radii_mm;
  auto anew = optimize_frame(problem, cold, context);
  if (!anew) return anew;
  const double reached = serves ? tried->geometry.volume_mm3 : 0;
  report->detail =
      serves
          ? fmt::format(
                "from its reduced frame {:.1f} mm3 were reached, more than the {:.1f} mm3 to be expected, so "
                "the optimiser began anew as well ({:.1f} mm3)",
                reached, most, anew->geometry.volume_mm3)
          : "its reduced frame cannot keep the new limits, so the optimiser began anew";
  add_effort(*sized, &anew.value());
  const bool anew_is_better =
      anew->reason != Termination::kInfeasible && anew->geometry.volume_mm3 <= reached;
  if (!serves || anew_is_better) return anew;
  return take_tried();
}

}  // namespace skinframe
