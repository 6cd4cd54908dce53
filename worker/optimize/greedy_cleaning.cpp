// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/greedy_cleaning.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <new>

#include "worker/optimize/block_ldlt.h"
#include "worker/optimize/design.h"
#include "worker/optimize/session.h"
#include "worker/optimize/size_frame.h"
#include "worker/run/one_blas_thread.h"

namespace skinframe {
namespace {

Status validate(const GreedyOptions& options) {
  if (!(options.radius_threshold >= 1)) return invalid_input("greedy: radius_threshold must be at least 1");
  if (!(options.largest_share > 0 && options.largest_share <= 1))
    return invalid_input("greedy: largest_share must lie in (0, 1]");
  if (options.max_rounds <= 0) return invalid_input("greedy: max_rounds must be positive");
  return options.optimize.validate();
}

// Thin removable struts, thinnest first.
std::vector<int> thin_struts(const Design& design, double radius_threshold) {
  const std::vector<bool> removable = removable_struts(design.problem);
  const std::vector<double> radii = radii_of(design.areas_mm2);
  std::vector<int> thin;
  for (int j = 0; j < static_cast<int>(radii.size()); ++j) {
    const double lower = radii_of({area_bounds(design.problem, j).lower_mm2}).front();
    if (removable[j] && radii[j] <= std::max(radius_threshold * lower, kVanishedRadiusMm)) thin.push_back(j);
  }
  std::stable_sort(thin.begin(), thin.end(), [&](int a, int b) { return radii[a] < radii[b]; });
  return thin;
}

Result<BaselineFrame> clean(const FrameProblem& problem, const GreedyOptions& options, RunContext& context) {
  Session session(options.optimize, context);
  session.enter(Stage::kTopology);
  BaselineFrame frame;
  Design design = initial_design(problem);
  SizedFrame first = size_frame(problem, {}, session);
  if (first.cancelled) return cancelled_error();
  const bool feasible = first.feasible();
  take_sizing(design, std::move(first));

  double share = options.largest_share;
  while (feasible && frame.rounds < options.max_rounds) {
    const std::vector<int> thin = thin_struts(design, options.radius_threshold);
    const auto leaving = static_cast<std::size_t>(std::ceil(share * static_cast<double>(thin.size())));
    if (leaving == 0) break;
    std::vector<bool> keep(design.areas_mm2.size(), true);
    for (std::size_t i = 0; i < leaving; ++i) keep[thin[i]] = false;
    Design fewer = reduced_design(design, keep);
    ++frame.rounds;
    bool taken = false;
    if (!fewer.problem.frame.struts.empty()) {
      SizedFrame sized = size_frame(fewer.problem, {}, session);
      if (sized.cancelled) return cancelled_error();
      taken = sized.feasible() && sized.volume_mm3() <= (1 + kVolumeTie) * design.volume_mm3;
      if (taken) take_sizing(fewer, std::move(sized));
    }
    if (taken)
      design = std::move(fewer);
    else if (leaving > 1)
      share /= 2;
    else
      break;
  }
  frame.radii_mm = radii_of(design.areas_mm2);
  frame.evaluation = evaluate(design.problem, frame.radii_mm);
  frame.feasible = is_feasible(frame.evaluation, options.optimize);
  frame.problem = std::move(design.problem);
  frame.node_origin = std::move(design.node_origin);
  frame.strut_origin = std::move(design.strut_origin);
  frame.interior_point_iterations = session.effort().iterations;
  frame.factorisations = session.effort().factorisations;
  return frame;
}

}  // namespace

Result<BaselineFrame> greedy_cleaning(const FrameProblem& problem, const GreedyOptions& options,
                                      RunContext& context) {
  if (Status s = skinframe::validate(problem); !s.ok()) return s.error();
  if (Status s = validate(options); !s.ok()) return s.error();
  if (context.cancelled()) return cancelled_error();
  use_one_blas_thread();
  try {
    return clean(problem, options, context);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    return internal_error(fmt::format("the greedy cleaning gave up: {}", e.what()));
  }
}

}  // namespace skinframe
