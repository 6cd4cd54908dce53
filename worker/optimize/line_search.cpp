// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/line_search.h"

#include <algorithm>
#include <cmath>

namespace skinframe {
namespace {

// Names and values after Waechter and Biegler 2006, section 2.3 and table 1.
constexpr double kGammaViolation = 1e-5, kGammaMerit = 1e-8, kArmijo = 1e-8;
constexpr double kViolationPower = 1.1, kMeritPower = 2.3;
constexpr double kLargestViolation = 1e4, kSmallViolation = 1e-4;  // relative to the first one
constexpr double kMeritRounding = 1e-12;
constexpr double kShortestStep = 1e-10;
constexpr int kMostHalvings = 25;

}  // namespace

LineSearch::Measure LineSearch::measure(const Iterate& it, double barrier) const {
  double violation = (inequalities(program_, layout_, it.point) + it.slacks).lpNorm<1>();
  for (const NodeMatrix& residual : equilibrium_residuals(program_, it.point))
    violation += residual.lpNorm<1>();
  return {violation, objective(program_, it.point) - barrier * it.slacks.array().log().sum()};
}

bool LineSearch::acceptable(const Measure& trial) const {
  return std::none_of(filter_.begin(), filter_.end(), [&](const Measure& left) {
    return trial.violation >= left.violation && trial.merit >= left.merit;
  });
}

std::optional<LineSearch::Accepted> LineSearch::search(const Iterate& it, const NewtonStep& step,
                                                       double barrier) {
  const Measure here = measure(it, barrier);
  if (!largest_violation_) {
    largest_violation_ = kLargestViolation * std::max(1.0, here.violation);
    small_violation_ = kSmallViolation * std::max(1.0, here.violation);
  }
  const double slope =
      objective_slope(program_, it.point, step.point) - barrier * step.slacks.cwiseQuotient(it.slacks).sum();
  const Measure margin{(1 - kGammaViolation) * here.violation, here.merit - kGammaMerit * here.violation};
  const double rounding = kMeritRounding * (std::abs(here.merit) + 1);

  double length = step.primal_length;
  for (int halving = 0; halving < kMostHalvings && length > kShortestStep; ++halving, length /= 2) {
    Iterate trial{it.point, it.slacks + length * step.slacks, it.duals};
    trial.point.add(length, step.point);
    follow_point(program_, layout_, trial);
    const Measure there = measure(trial, barrier);
    if (!std::isfinite(there.merit) || !(there.violation <= *largest_violation_) || !acceptable(there))
      continue;
    const bool objective_leads =
        slope < 0 && here.violation <= *small_violation_ &&
        length * std::pow(-slope, kMeritPower) > std::pow(here.violation, kViolationPower);
    if (objective_leads) {
      if (there.merit <= here.merit + kArmijo * length * slope + rounding)
        return Accepted{std::move(trial), length, halving};
    } else if (there.violation <= margin.violation || there.merit <= margin.merit + rounding) {
      filter_.push_back(margin);
      return Accepted{std::move(trial), length, halving};
    }
  }
  return std::nullopt;
}

}  // namespace skinframe
