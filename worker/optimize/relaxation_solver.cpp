// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/relaxation_solver.h"

#include <algorithm>
#include <cmath>

#include "worker/optimize/relaxation_system.h"

namespace skinframe {
namespace {

using Eigen::VectorXd;

constexpr double kStepShare = 0.99;    // of the way to the nearest bound
constexpr double kStartShare = 0.05;   // a start keeps this share of its area, or of the range, to a bound
constexpr double kStartBarrier = 0.1;  // products of areas and their duals
// The fields count as displacements of the areas when their forces miss by this share of the largest load.
constexpr double kNearlyInEquilibrium = 1e-3;
constexpr double kLeastStep = 1e-6;      // below it nothing moves any more
constexpr double kLeastCentring = 0.02;  // of the mean complementarity

VectorXd within_bounds(const Relaxation& p, const VectorXd& areas) {
  VectorXd inside = areas;
  for (int j = 0; j < p.strut_count(); ++j) {
    if (p.area_is_given(j)) {
      inside[j] = p.lower[j];
      continue;
    }
    const double range = p.upper[j] - p.lower[j];
    const double keep = kStartShare * std::min(range, std::max(areas[j], 1.0));
    inside[j] = std::clamp(areas[j], p.lower[j] + keep, p.upper[j] - keep);
  }
  return inside;
}

// w = u y.
VectorXd fields_of(const Relaxation& p, const SaddlePoint& point, const VectorXd& displacements) {
  VectorXd weights(p.case_count()), fields = displacements;
  for (int k = 0; k < p.case_count(); ++k) weights[k] = case_weight(p, point, k);
  scale_cases(p, weights, &fields);
  return fields;
}

// So that the cost's gradient is met on average where areas stand above their lower bounds.
VectorXd start_multipliers(const Relaxation& p, const VectorXd& areas, const VectorXd& displacements,
                           bool least_excess) {
  const int terms = p.term_count();
  const VectorXd even = VectorXd::Constant(terms, 0.5 / std::max(terms, 1));
  if (least_excess) return even;
  int energies = 0;
  for (const RelaxedTerm& term : p.terms) energies += term.kind != TermKind::kBalance;
  if (energies == 0) return even;
  SaddlePoint trial{areas, {}, even};
  for (int c = 0; c < terms; ++c)
    trial.multipliers[c] = p.terms[c].kind == TermKind::kBalance ? 1e-2 : 1.0 / energies;
  trial.fields = fields_of(p, trial, displacements);
  const VectorXd room = areas - (1 - kStartShare) * p.lower;
  const double falls = -dual_form(p, trial).slope.dot(room);
  return falls > 0 ? VectorXd(trial.multipliers * (p.cost.dot(room) / falls)) : trial.multipliers;
}

RelaxationIterate start(const Relaxation& p, const VectorXd& areas, const VectorXd& displacements,
                        bool least_excess) {
  RelaxationIterate at;
  at.point.areas = within_bounds(p, areas);
  at.point.multipliers = start_multipliers(p, at.point.areas, displacements, least_excess);
  at.point.fields = fields_of(p, at.point, displacements);
  const VectorXd excess = relaxation_values(p, at.point).excess;
  const int struts = p.strut_count();
  double barrier = kStartBarrier;
  if (least_excess) {
    at.excess_bound = std::max(2 * excess.maxCoeff(), 1e-2 * struts);
    at.excess_slack = 0.5;
    barrier *= at.excess_bound / struts;
  }
  at.below_dual = at.above_dual = VectorXd::Zero(struts);
  for (int j = 0; j < struts; ++j) {
    if (p.area_is_given(j)) continue;
    at.below_dual[j] = barrier / (at.point.areas[j] - p.lower[j]);
    at.above_dual[j] = barrier / (p.upper[j] - at.point.areas[j]);
  }
  at.slacks.resize(p.term_count());
  for (int c = 0; c < p.term_count(); ++c)
    at.slacks[c] = std::max(at.excess_bound - excess[c], 1e-2 * struts);
  return at;
}

double worst_residual(const Relaxation& p, const RelaxationIterate& at, const RelaxationValues& values) {
  double worst = values.worst_force();
  for (int j = 0; j < p.strut_count(); ++j)
    if (!p.area_is_given(j))
      worst = std::max(worst, std::abs(values.gradient[j] - at.below_dual[j] + at.above_dual[j]));
  for (int c = 0; c < p.term_count(); ++c)
    worst = std::max(worst, std::abs(values.excess[c] + at.slacks[c] - at.excess_bound) / p.strut_count());
  return worst;
}

}  // namespace

RelaxationOutcome solve_relaxation(const Relaxation& p, const VectorXd& start_areas,
                                   const VectorXd& start_displacements, const RelaxationOptions& options) {
  const bool bounded = options.least_excess;
  RelaxationIterate at = start(p, start_areas, start_displacements, bounded);
  RelaxationSystem system(p, bounded);
  RelaxationOutcome outcome;
  for (; outcome.iterations < options.max_iterations; ++outcome.iterations) {
    const RelaxationValues values = relaxation_values(p, at.point);
    if (options.each(at.point)) return outcome;
    if (bounded && values.excess.size() > 0 && values.excess.maxCoeff() <= 0 &&
        values.worst_force() <= kNearlyInEquilibrium) {
      outcome.feasible = true;
      return outcome;
    }
    const double mean = mean_product(p, at, bounded);
    if (worst_residual(p, at, values) <= options.tolerance && mean <= options.tolerance) {
      outcome.converged = true;
      return outcome;
    }
    if (!system.factorise(at, values)) return outcome;
    // Mehrotra's choice of the barrier: from how far the affine step would bring the products down.
    const RelaxationIterate affine = system.step(at, values, 0);
    const double left =
        mean_product_after(p, at, affine, step_length(p, at, affine, 1.0, bounded), bounded) / mean;
    const RelaxationIterate step =
        system.step(at, values, std::max(left * left * left, kLeastCentring) * mean);
    const double length = step_length(p, at, step, kStepShare, bounded);
    if (!(length > kLeastStep)) return outcome;
    advance(p, values, step, length, &at);
  }
  return outcome;
}

}  // namespace skinframe
