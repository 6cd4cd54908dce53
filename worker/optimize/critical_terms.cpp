// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/critical_terms.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "worker/mechanics/evaluation.h"

namespace skinframe {
namespace {

std::vector<int> greatest_first(const std::vector<double>& measure) {
  std::vector<int> order(measure.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return measure[a] > measure[b]; });
  return order;
}

}  // namespace

CriticalTerms critical_terms(const FrameProblem& problem, const std::vector<double>& areas_mm2,
                             double binding_share, int most_cases, int most_half_planes) {
  const std::vector<double> radii = radii_of(areas_mm2);
  std::vector<CaseResponse> responses = solve_equilibrium(problem, areas_mm2);
  std::vector<double> demand;
  for (const CaseResponse& response : responses)
    demand.push_back(utilisation(evaluate(problem, radii, {response})));
  CriticalTerms critical;
  for (int k : greatest_first(demand)) {
    if (static_cast<int>(critical.load_cases.size()) == most_cases) break;
    if (!critical.load_cases.empty() && demand[k] < binding_share) break;
    critical.load_cases.push_back(k);
    critical.responses.push_back(std::move(responses[k]));
  }
  if (problem.balance.empty()) return critical;
  const Eigen::Vector2d centre = evaluate(problem, radii, {}).centre_of_gravity_mm.head<2>();
  std::vector<double> beyond;
  for (const HalfPlane& plane : problem.balance) beyond.push_back(plane.normal.dot(centre) - plane.offset_mm);
  for (int plane : greatest_first(beyond))
    if (static_cast<int>(critical.half_planes.size()) < most_half_planes)
      critical.half_planes.push_back(plane);
  return critical;
}

Eigen::VectorXd stacked_displacements(const Relaxation& relaxation, const CriticalTerms& critical) {
  const int cases = relaxation.case_count();
  Eigen::VectorXd stacked(relaxation.external.size());
  for (int k = 0; k < cases; ++k) {
    const auto at =
        std::find(critical.load_cases.begin(), critical.load_cases.end(), relaxation.load_cases[k]);
    const NodeVectors& field =
        critical.responses[static_cast<std::size_t>(at - critical.load_cases.begin())].displacements_mm;
    for (std::size_t i = 0; i < field.size(); ++i)
      stacked.segment<3>(3 * (cases * static_cast<int>(i) + k)) = field[i] / relaxation.displacement_mm;
  }
  return stacked;
}

}  // namespace skinframe
