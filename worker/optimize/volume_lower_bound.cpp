// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/volume_lower_bound.h"

#include <algorithm>
#include <cmath>

#include "worker/mechanics/evaluation.h"
#include "worker/optimize/critical_terms.h"
#include "worker/optimize/relaxation_solver.h"

namespace skinframe {
namespace {

// The search ends when the bound is this close to the best volume known, or to the relaxation's own optimum.
constexpr double kMet = 1e-7;
constexpr double kSettled = 1e-5;
// A load case takes part when its demand is at least this share of the limit.
constexpr double kBindingShare = 0.9;

}  // namespace

VolumeBound volume_lower_bound(const FrameProblem& problem, const BoundRequest& request) {
  VolumeBound bound;
  bound.proof.volume_weight = 1;
  bound.proof.feasibility_tolerance = request.feasibility_tolerance;
  bound.value_mm3 = (1 - kBoundRounding) * dual_value(problem, request.box, bound.proof).value;
  const auto met = [&] { return bound.value_mm3 >= (1 - kMet) * request.volume_mm3; };

  const CriticalTerms critical =
      critical_terms(problem, request.start_mm2, kBindingShare, kMostBoundCases, kMostBoundHalfPlanes);
  RelaxationRequest ask;
  ask.load_cases = critical.load_cases;
  ask.half_planes = critical.half_planes;
  ask.volume_weight = 1;
  ask.feasibility_tolerance = request.feasibility_tolerance;
  ask.start_mm2 = request.start_mm2;
  ask.responses = critical.responses;
  const Relaxation relaxation = relax(problem, request.box, ask);
  if (relaxation.terms.empty() || met()) return bound;

  SaddlePoint best;
  double best_value = -1, best_factor = 0;
  int meetings = 0;  // iterates in a row whose own cost the bound meets
  RelaxationOptions options;
  options.each = [&](const SaddlePoint& point) {
    const auto [scale, value] = best_scale(relaxation, dual_form(relaxation, point));
    if (value > best_value) best = point, best_value = value, best_factor = scale;
    ++bound.iterations;
    const double cost = relaxation.cost.dot(point.areas);
    meetings = std::abs(cost - best_value) <= kSettled * best_value ? meetings + 1 : 0;
    return request.cancelled() || meetings == 2 ||
           best_value * relaxation.volume_mm3 >= (1 - kMet) * request.volume_mm3;
  };
  const Eigen::VectorXd areas =
      Eigen::VectorXd::Map(request.start_mm2.data(), relaxation.strut_count()) / relaxation.area_mm2;
  solve_relaxation(relaxation, areas, stacked_displacements(relaxation, critical), options);
  if (!(best_value > 0)) return bound;
  DualProof proof = proof_of(relaxation, best, best_factor, problem.balance.size());
  const double value = (1 - kBoundRounding) * dual_value(problem, request.box, proof).value;
  if (!(value > bound.value_mm3)) return bound;
  bound.value_mm3 = value;
  bound.proof = std::move(proof);
  return bound;
}

}  // namespace skinframe
