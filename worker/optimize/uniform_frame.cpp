// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/uniform_frame.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "worker/optimize/design.h"
#include "worker/optimize/uniform_start.h"

namespace skinframe {
namespace {

constexpr int kMostBisections = 60;
constexpr double kStep = 0.8;  // downwards from the feasible start, until it is not

}  // namespace

Result<BaselineFrame> uniform_frame(const FrameProblem& problem, const UniformOptions& options) {
  if (Status s = validate(problem); !s.ok()) return s.error();
  if (!(options.relative_tolerance > 0 && options.relative_tolerance < 1))
    return invalid_input("uniform frame: relative_tolerance must lie in (0, 1)");
  std::vector<double> lower, upper;
  for (int j = 0; j < static_cast<int>(problem.frame.struts.size()); ++j) {
    const AreaBounds bounds = area_bounds(problem, j);
    lower.push_back(bounds.lower_mm2);
    upper.push_back(bounds.upper_mm2);
  }
  EquilibriumSolver solver(problem);
  BaselineFrame frame;
  const auto clipped = [&](double radius) {
    std::vector<double> areas = lower;
    for (std::size_t j = 0; j < areas.size(); ++j)
      areas[j] = std::clamp(std::numbers::pi * radius * radius, lower[j], upper[j]);
    return areas;
  };
  const auto holds = [&](const std::vector<double>& areas) {
    ++frame.rounds;
    return utilisation(evaluate(problem, radii_of(areas), solver.solve(areas))) <=
           1 + options.feasibility_tolerance;
  };
  UniformStart start = uniform_start(problem, lower, upper, solver);
  std::vector<double> best = std::move(start.areas_mm2);
  if (start.utilisation <= 1) {
    double above = std::sqrt(*std::max_element(best.begin(), best.end()) / std::numbers::pi);
    const double least = std::sqrt(*std::min_element(lower.begin(), lower.end()) / std::numbers::pi);
    double below = above;
    while (below > least) {
      const double next = std::max(least, kStep * below);
      std::vector<double> areas = clipped(next);
      below = next;
      if (!holds(areas)) break;
      above = next;
      best = std::move(areas);
    }
    for (int step = 0; step < kMostBisections && above - below > options.relative_tolerance * above; ++step) {
      const double middle = (above + below) / 2;
      std::vector<double> areas = clipped(middle);
      if (holds(areas)) {
        above = middle;
        best = std::move(areas);
      } else {
        below = middle;
      }
    }
  }
  Design design = initial_design(problem);
  frame.problem = std::move(design.problem);
  frame.node_origin = std::move(design.node_origin);
  frame.strut_origin = std::move(design.strut_origin);
  frame.radii_mm = radii_of(best);
  frame.evaluation = evaluate(frame.problem, frame.radii_mm);
  frame.feasible = violated_constraint(frame.evaluation, options.feasibility_tolerance).empty();
  return frame;
}

}  // namespace skinframe
