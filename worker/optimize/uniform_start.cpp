// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/uniform_start.h"

#include <algorithm>
#include <cmath>

#include "worker/mechanics/evaluation.h"

namespace skinframe {
namespace {

constexpr double kScanFactor = 1.6;  // between the areas scanned
constexpr int kMostScans = 40;
constexpr double kCloseEnough = 1.02;  // ratio of the bracket's areas
constexpr int kMostRefinements = 20;
constexpr double kSmallestShare = 1e-4;  // of the largest area, where lower bounds are zero

}  // namespace

UniformStart uniform_start(const FrameProblem& problem, const std::vector<double>& lower_mm2,
                           const std::vector<double>& upper_mm2, EquilibriumSolver& solver) {
  const auto at = [&](double area) {
    UniformStart start{lower_mm2, 0};
    for (std::size_t j = 0; j < lower_mm2.size(); ++j)
      start.areas_mm2[j] = std::clamp(area, lower_mm2[j], upper_mm2[j]);
    start.utilisation =
        utilisation(evaluate(problem, radii_of(start.areas_mm2), solver.solve(start.areas_mm2)));
    return start;
  };
  const double most = *std::max_element(upper_mm2.begin(), upper_mm2.end());
  const double least = std::max(*std::min_element(lower_mm2.begin(), lower_mm2.end()), kSmallestShare * most);

  double below = least;  // infeasible, or the end of the range
  UniformStart best = at(least);
  double area = least;
  for (int scan = 0; best.utilisation > 1 && area < most && scan < kMostScans; ++scan) {
    below = area;
    area = std::min(area * kScanFactor, most);
    UniformStart next = at(area);
    if (next.utilisation < best.utilisation) best = std::move(next);
  }
  if (best.utilisation > 1) return best;
  for (int step = 0; area / below > kCloseEnough && step < kMostRefinements; ++step) {
    const double middle = std::sqrt(area * below);
    UniformStart next = at(middle);
    if (next.utilisation <= 1) {
      best = std::move(next);
      area = middle;
    } else {
      below = middle;
    }
  }
  return best;
}

}  // namespace skinframe
