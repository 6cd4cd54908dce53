// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/uniform_start.h"

#include <algorithm>
#include <cmath>

#include "worker/mechanics/evaluation.h"

namespace skinframe {
namespace {

constexpr double kScanFactor = 1.6;  // between the areas scanned, where the utilisation cannot be trusted
constexpr double kLargestStep = 4;   // of one step on the utilisation's word
constexpr int kMostScans = 40;
constexpr double kCloseEnough = 1.02;  // ratio of the bracket's areas, and of the utilisation to its limit
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

  // Displacements go about as 1 / area, so the utilisation says how far to step. Self weight goes another
  // way: where the utilisation rises with the area its word is no longer taken.
  UniformStart best = at(least);
  double area = least, below = least, below_utilisation = best.utilisation;
  double last = best.utilisation;
  bool trusted = true;
  for (int scan = 0; best.utilisation > 1 && area < most && scan < kMostScans; ++scan) {
    const double wanted = trusted ? std::clamp(last * kCloseEnough, kCloseEnough, kLargestStep) : kScanFactor;
    const double next_area = std::min(area * (std::isfinite(wanted) ? wanted : kLargestStep), most);
    UniformStart next = at(next_area);
    if (trusted && !(next.utilisation < last)) {
      trusted = false;  // from where it still fell, in small steps
      continue;
    }
    last = next.utilisation;
    if (next.utilisation > 1) below = next_area, below_utilisation = next.utilisation;
    area = next_area;
    if (next.utilisation < best.utilisation) best = std::move(next);
  }
  if (best.utilisation > 1) return best;
  // The secant through both ends of the bracket, in logarithms, a little to the feasible side.
  for (int step = 0; step < kMostRefinements; ++step) {
    if (area / below <= kCloseEnough || best.utilisation * kCloseEnough >= 1) break;
    const double high = std::log(below_utilisation), low = std::log(best.utilisation);
    const double share = std::isfinite(high - low) ? std::clamp(high / (high - low) + 0.02, 0.1, 0.9) : 0.5;
    const double middle = below * std::pow(area / below, share);
    UniformStart next = at(middle);
    if (next.utilisation <= 1) {
      best = std::move(next);
      area = middle;
    } else {
      below = middle;
      below_utilisation = next.utilisation;
    }
  }
  return best;
}

}  // namespace skinframe
