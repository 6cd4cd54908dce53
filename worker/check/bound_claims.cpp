// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "worker/check/claims.h"

namespace skinframe::check {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

constexpr double kGravity = 9810.0;             // mm/s2
constexpr double kSlenderRoom = 1.01;           // a strut too long for its upper bound has this room above
constexpr double kVolumeTolerance = 1e-6;       // relative, of bounds against volumes and gaps
constexpr double kProofTolerance = 1e-9;        // relative, of a reported bound against the one verified
constexpr double kMostFeasibilitySlack = 1e-2;  // what a proof may count as keeping the limits

// What one unit of a strut's area, or nothing at all, adds to the sum of the proof's inequalities.
struct Terms {
  double constant = 0;
  std::vector<double> of_strut;
};

bool free_axis(const ExportedFrame& frame, int node, int axis) { return !frame.fixed[node][axis]; }

Vector3d held(const ExportedFrame& frame, int node, Vector3d v) {
  for (int axis = 0; axis < 3; ++axis)
    if (!free_axis(frame, node, axis)) v[axis] = 0;
  return v;
}

// False where a multiplier asks for a limit that the frame does not have.
bool add_field(const ExportedFrame& frame, const ExportedField& field, double tolerance, Terms* terms) {
  const double u = field.displacement_multiplier, v = field.stress_multiplier;
  if (!(u >= 0) || !(v >= 0) || (u > 0 && !frame.displacement_limit_mm)) return false;
  if (v > 0 && (!frame.tensile_strength_mpa || (!frame.axial && !frame.shear_strength_mpa))) return false;
  const double limit = u > 0 ? (1 + tolerance) * *frame.displacement_limit_mm : 0.0;
  double energy_density = 0;  // that the strengths allow
  if (v > 0) {
    const double sigma = (1 + tolerance) * *frame.tensile_strength_mpa;
    energy_density = sigma * sigma / frame.tensile_modulus_mpa;
    if (!frame.axial) {
      const double tau = (1 + tolerance) * *frame.shear_strength_mpa;
      energy_density += tau * tau / frame.shear_modulus_mpa;
    }
  }
  const ExportedLoadCase& load = frame.load_cases[field.load_case];
  const int nodes = static_cast<int>(frame.nodes_mm.size());
  std::vector<Vector3d> y;
  for (int i = 0; i < nodes; ++i) {
    y.push_back(held(frame, i, field.displacement_mm[i]));
    Vector3d force = load.force_n[i];
    if (load.gravity) force.z() -= frame.skin_weight_n[i];
    force = held(frame, i, force);
    terms->constant += 2 * (u + v) * force.dot(y[i]) - u * limit * force.norm();
  }
  const double weight_density = load.gravity ? frame.density_g_cm3 * 1e-9 * kGravity : 0.0;
  for (std::size_t j = 0; j < frame.struts.size(); ++j) {
    const ExportedStrut& s = frame.struts[j];
    const Vector3d e = frame.nodes_mm[s.b] - frame.nodes_mm[s.a], delta = y[s.b] - y[s.a];
    const double l = e.norm(), stretch = e.dot(delta) / l;
    const double slip = (delta - stretch / l * e).squaredNorm();
    const double energy =
        (frame.tensile_modulus_mpa * stretch * stretch + frame.shear_modulus_mpa * slip) / l;
    double term = -(u + v) * energy - v * energy_density * l;
    for (const int end : {s.a, s.b}) {
      const double half = 0.5 * weight_density * l;
      term -= 2 * (u + v) * half * y[end].z();
      if (free_axis(frame, end, 2)) term -= u * limit * half;
    }
    terms->of_strut[j] += term;
  }
  return true;
}

bool add_balance(const ExportedFrame& frame, std::size_t plane, double multiplier, double tolerance_mm,
                 Terms* terms) {
  if (!(multiplier >= 0)) return false;
  const auto& [normal, offset_mm] = frame.balance_half_planes[plane];
  const auto beyond = [&, n = normal, o = offset_mm](const Vector3d& p) {
    return n.dot(p.head<2>()) - o - tolerance_mm;
  };
  terms->constant += multiplier * frame.skin_mass_weight_n * beyond(frame.skin_centroid_mm);
  for (std::size_t j = 0; j < frame.struts.size(); ++j) {
    const Vector3d &a = frame.nodes_mm[frame.struts[j].a], &b = frame.nodes_mm[frame.struts[j].b];
    terms->of_strut[j] +=
        multiplier * frame.density_g_cm3 * 1e-9 * kGravity * (b - a).norm() * beyond(0.5 * (a + b));
  }
  return true;
}

// The least of volume_weight * volume + the inequalities' sum over all areas within bounds; none where the
// proof is malformed.
std::optional<double> verified(const ExportedFrame& frame, const ExportedProof& proof) {
  if (!(proof.feasibility_tolerance >= 0 && proof.feasibility_tolerance <= kMostFeasibilitySlack))
    return std::nullopt;
  Terms terms{0, std::vector<double>(frame.struts.size(), 0.0)};
  for (const ExportedField& field : proof.fields)
    if (!add_field(frame, field, proof.feasibility_tolerance, &terms)) return std::nullopt;
  for (std::size_t p = 0; p < proof.balance_multipliers.size(); ++p)
    if (!add_balance(frame, p, proof.balance_multipliers[p], proof.feasibility_tolerance, &terms))
      return std::nullopt;
  double least = terms.constant;
  for (std::size_t j = 0; j < frame.struts.size(); ++j) {
    const ExportedStrut& s = frame.struts[j];
    const double l = (frame.nodes_mm[s.b] - frame.nodes_mm[s.a]).norm();
    const double slender = frame.slenderness ? l / *frame.slenderness : 0.0;
    double lower = std::max(s.min_radius_mm, slender);
    const double upper = slender > s.max_radius_mm ? kSlenderRoom * slender : s.max_radius_mm;
    if (proof.removable_may_vanish && (!s.skin || s.min_radius_mm == 0)) lower = 0;
    const double term = proof.volume_weight * l + terms.of_strut[j];
    least += std::min(term * pi * lower * lower, term * pi * upper * upper);
  }
  return std::isfinite(least) ? std::optional(least) : std::nullopt;
}

Vector3d total_force(const ExportedLoadCase& load) {
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& force : load.force_n) sum += force;
  return sum;
}

// That a bound for `given` says something about `made`: both answer the same question.
bool same_terms(const ExportedFrame& given, const ExportedFrame& made) {
  const auto terms = [](const ExportedFrame& f) {
    return std::tuple(f.axial, f.tensile_modulus_mpa, f.shear_modulus_mpa, f.density_g_cm3,
                      f.tensile_strength_mpa, f.shear_strength_mpa, f.slenderness, f.displacement_limit_mm,
                      f.load_cases.size(), f.skin_mass_weight_n);
  };
  if (terms(given) != terms(made)) return false;
  for (std::size_t k = 0; k < given.load_cases.size(); ++k) {
    const ExportedLoadCase &a = given.load_cases[k], &b = made.load_cases[k];
    const Vector3d force = total_force(a);
    if (a.name != b.name || a.gravity != b.gravity ||
        (force - total_force(b)).norm() > kVolumeTolerance * (1 + force.norm()))
      return false;
  }
  return true;
}

void claim_certificate(const ExportedPrinter& result, Verdict* verdict) {
  if (!result.infeasibility_proven && !result.certificate) return;
  std::optional<double> value;
  if (result.certificate && result.certificate->volume_weight == 0 &&
      !result.certificate->removable_may_vanish)
    value = verified(result.frame, *result.certificate);
  verdict->claims.push_back(
      {"no radii keep the limits", result.infeasible() && value && *value > 0,
       value
           ? fmt::format("whatever the radii within their bounds, the loads do {:.6g} N mm of work more than "
                         "the limits allow, times the proof's multipliers (reported {:.6g})",
                         *value, result.certificate->value)
           : "called proven, but there is no proof that can be verified"});
}

struct BoundFigures {
  const char* name;
  const char* of;  // the stage whose volume it bounds
  std::optional<double> bound_mm3, gap;
  double volume_mm3;
  const std::optional<ExportedProof>* proof;
  bool removable_may_vanish;
};

void claim_bound(const ExportedPrinter& result, const BoundFigures& f, Verdict* verdict) {
  if (!f.bound_mm3) return;
  const double bound = *f.bound_mm3;
  const bool below = bound <= f.volume_mm3 * (1 + kVolumeTolerance);
  const bool gap = !f.gap || std::abs(f.volume_mm3 / bound - 1 - *f.gap) <= kVolumeTolerance * (1 + *f.gap);
  verdict->claims.push_back({f.name, below && gap,
                             fmt::format("bound {:.6g} mm3, {} {:.6g} mm3, {:.3f} % above (reported {})",
                                         bound, f.of, f.volume_mm3, 100 * (f.volume_mm3 / bound - 1),
                                         f.gap ? fmt::format("{:.3f} %", 100 * *f.gap) : "none")});
  std::optional<double> value;
  if (result.given && same_terms(*result.given, result.frame) && *f.proof && (*f.proof)->volume_weight == 1 &&
      (*f.proof)->removable_may_vanish == f.removable_may_vanish)
    value = verified(*result.given, **f.proof);
  verdict->claims.push_back(
      {fmt::format("{}, proven", f.name), value && bound <= *value + kProofTolerance * std::abs(*value),
       value ? fmt::format("no radii on the nodes and struts given make less than {:.6g} mm3", *value)
             : "there is no proof that can be verified for a frame of these loads, limits and material"});
}

}  // namespace

void claim_bounds(const ExportedPrinter& result, Verdict* verdict) {
  claim_certificate(result, verdict);
  if (!result.optimised() || result.infeasible()) return;
  claim_bound(result,
              {"lower bound of the sized volume", "size", result.lower_bound_mm3, result.gap,
               result.size_volume_mm3, &result.bound_proof, false},
              verdict);
  claim_bound(result,
              {"lower bound of the reduced volume", "topology", result.relaxed_lower_bound_mm3,
               result.relaxed_gap, result.topology_volume_mm3, &result.relaxed_bound_proof, true},
              verdict);
}

}  // namespace skinframe::check
