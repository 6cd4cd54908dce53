// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/infeasibility_certificate.h"

#include <algorithm>
#include <cmath>

#include "worker/optimize/critical_terms.h"
#include "worker/optimize/relaxation_solver.h"

namespace skinframe {
namespace {

constexpr int kMostHalfPlanes = 64;
constexpr int kMostJointHalfPlanes = 8;
// A proof is looked at in mm and N when its scaled value is positive by this share of its terms.
constexpr double kPromising = 2e-7;
constexpr int kMostIterations = 40;
constexpr double kWidestRatio = 1e12;
constexpr int kRatioSteps = 30;

std::string constraint_of(const DualProof& proof) {
  bool displacement = false, stress = false, balance = false;
  for (const VirtualField& field : proof.fields) {
    displacement |= field.displacement_multiplier > 0;
    stress |= field.stress_multiplier > 0;
  }
  for (double multiplier : proof.balance_multipliers) balance |= multiplier > 0;
  std::string name;
  const std::pair<bool, const char*> parts[] = {
      {displacement, "displacement"}, {stress, "stress"}, {balance, "balance"}};
  for (const auto& [part, word] : parts)
    if (part) name += (name.empty() ? "" : " and ") + std::string(word);
  return name;
}

// The widest limits that the proof still refutes: its value falls with them, and the tolerance on the limits
// is what widens them.
double proven_ratio(const FrameProblem& problem, const AreaBox& box, DualProof proof) {
  for (double multiplier : proof.balance_multipliers)
    if (multiplier > 0) return 1;
  const double exact = proof.feasibility_tolerance;
  const auto refutes = [&](double ratio) {
    proof.feasibility_tolerance = (1 + exact) * ratio - 1;
    const DualValue value = dual_value(problem, box, proof);
    return value.value > kCertain * value.normalisation;
  };
  double low = 1, high = 2;
  while (refutes(high) && high < kWidestRatio) low = high, high *= 2;
  for (int step = 0; step < kRatioSteps; ++step) {
    const double middle = (low + high) / 2;
    (refutes(middle) ? low : high) = middle;
  }
  return low;
}

// Evaluated afresh; none where it proves nothing.
std::optional<InfeasibilityCertificate> certificate(const FrameProblem& problem, const AreaBox& box,
                                                    DualProof proof) {
  const DualValue value = dual_value(problem, box, proof);
  if (!(value.value > kCertain * value.normalisation) || !std::isfinite(value.value)) return std::nullopt;
  InfeasibilityCertificate out{std::move(proof), box, value.value, value.normalisation, 1, {}};
  out.constraint = constraint_of(out.proof);
  out.proven_ratio = proven_ratio(problem, box, out.proof);
  return out;
}

// The displacements at the areas themselves as the field: for loads far out of reach it takes no more.
std::optional<InfeasibilityCertificate> certify_at(const FrameProblem& problem,
                                                   const CertificateRequest& request,
                                                   const CriticalTerms& critical) {
  for (std::size_t k = 0; k < critical.load_cases.size(); ++k)
    for (const bool stress : {false, true}) {
      if (!stress && !problem.displacement_limit_mm) continue;
      if (stress && !std::isfinite(allowed_energy_density_mpa(problem, request.feasibility_tolerance)))
        continue;
      DualProof proof;
      proof.feasibility_tolerance = request.feasibility_tolerance;
      proof.fields.push_back({critical.load_cases[k], stress ? 0.0 : 1.0, stress ? 1.0 : 0.0,
                              critical.responses[k].displacements_mm});
      if (auto proven = certificate(problem, request.box, std::move(proof))) return proven;
    }
  return std::nullopt;
}

std::optional<InfeasibilityCertificate> search(const FrameProblem& problem, const CertificateRequest& request,
                                               const CriticalTerms& critical) {
  RelaxationRequest ask;
  ask.load_cases = critical.load_cases;
  ask.half_planes = critical.half_planes;
  ask.feasibility_tolerance = request.feasibility_tolerance;
  ask.start_mm2 = request.start_mm2;
  ask.responses = critical.responses;
  const Relaxation relaxation = relax(problem, request.box, ask);
  if (relaxation.terms.empty()) return std::nullopt;
  std::optional<InfeasibilityCertificate> proven;
  RelaxationOptions options;
  options.least_excess = true;
  options.max_iterations = kMostIterations;
  options.each = [&](const SaddlePoint& point) {
    if (least_over_box(relaxation, dual_form(relaxation, point), 1.0) >
        kPromising * relaxation.strut_count() * point.multipliers.sum())
      proven = certificate(problem, request.box, proof_of(relaxation, point, 1.0, problem.balance.size()));
    return proven.has_value() || request.cancelled();
  };
  const Eigen::VectorXd areas =
      Eigen::VectorXd::Map(request.start_mm2.data(), relaxation.strut_count()) / relaxation.area_mm2;
  solve_relaxation(relaxation, areas, stacked_displacements(relaxation, critical), options);
  return proven;
}

CriticalTerms only_worst(const CriticalTerms& all) {
  CriticalTerms worst;
  if (all.load_cases.empty()) return worst;
  worst.load_cases = {all.load_cases.front()};
  worst.responses = {all.responses.front()};
  return worst;
}

}  // namespace

std::optional<InfeasibilityCertificate> certify_infeasible(const FrameProblem& problem,
                                                           const CertificateRequest& request) {
  const CriticalTerms at_upper = critical_terms(problem, request.box.upper_mm2, 1.0, kMostCertifiedCases, 0);
  if (auto proven = certify_at(problem, request, at_upper)) return proven;
  const CriticalTerms critical =
      critical_terms(problem, request.start_mm2, 1.0, kMostCertifiedCases, kMostJointHalfPlanes);
  if (auto proven = certify_at(problem, request, critical)) return proven;
  const CriticalTerms worst = only_worst(critical);
  if (worst.load_cases.empty()) return std::nullopt;
  if (auto proven = search(problem, request, worst)) return proven;
  if (critical.load_cases.size() < 2 && critical.half_planes.empty()) return std::nullopt;
  return search(problem, request, critical);
}

std::optional<InfeasibilityCertificate> certify_unbalanced(const FrameProblem& problem,
                                                           const CertificateRequest& request) {
  CriticalTerms rows = critical_terms(problem, request.start_mm2, 1.0, 0, kMostHalfPlanes);
  for (int plane : rows.half_planes) {
    DualProof proof;
    proof.feasibility_tolerance = request.feasibility_tolerance;
    proof.balance_multipliers.assign(problem.balance.size(), 0);
    proof.balance_multipliers[plane] = 1;
    if (auto proven = certificate(problem, request.box, std::move(proof))) return proven;
  }
  return search(problem, request, rows);
}

}  // namespace skinframe
