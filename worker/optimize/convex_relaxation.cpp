// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/convex_relaxation.h"

#include <algorithm>
#include <cmath>

#include "worker/mechanics/strut_element.h"

namespace skinframe {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kScaleSteps = 100;
constexpr double kMostScale = 1e12;
// Stress joins the displacement limit when it allows less than this times as much energy at the start.
constexpr double kStressMatters = 4;

class Builder {
 public:
  Builder(const FrameProblem& problem, const AreaBox& box, const RelaxationRequest& request)
      : problem_(problem), request_(request), struts_(static_cast<int>(problem.frame.struts.size())) {
    set_units();
    set_struts(box);
    for (std::size_t k = 0; k < request.load_cases.size(); ++k) add_case(static_cast<int>(k));
    set_loads();
    for (int plane : request.half_planes) add_balance(plane);
  }

  Relaxation take() { return std::move(out_); }

 private:
  double length(int j) const { return problem_.frame.length_mm(problem_.frame.struts[j]); }

  void set_units() {
    double lengths = 0, volume = 0;
    for (int j = 0; j < struts_; ++j) lengths += length(j), volume += length(j) * request_.start_mm2[j];
    out_.area_mm2 = volume / lengths;
    out_.volume_mm3 = volume / struts_;
    double largest = 0;
    for (const CaseResponse& response : request_.responses)
      largest = std::max(largest, response.max_displacement_mm);
    out_.displacement_mm = problem_.displacement_limit_mm.value_or(largest > 0 ? largest : 1.0);
    out_.volume_weight = request_.volume_weight;
    out_.feasibility_tolerance = request_.feasibility_tolerance;
  }

  void set_struts(const AreaBox& box) {
    out_.fixed = problem_.fixed;
    out_.lower = VectorXd::Map(box.lower_mm2.data(), struts_) / out_.area_mm2;
    out_.upper = VectorXd::Map(box.upper_mm2.data(), struts_) / out_.area_mm2;
    out_.cost = VectorXd::Zero(struts_);
    for (int j = 0; j < struts_; ++j) {
      out_.struts.emplace_back(problem_.frame.struts[j].a, problem_.frame.struts[j].b);
      out_.cost[j] = request_.volume_weight * length(j) * out_.area_mm2 / out_.volume_mm3;
    }
  }

  Vector3d external_n(int load_case, int node) const {
    const LoadCase& load = problem_.load_cases[load_case];
    Vector3d force = load.force_n[node];
    if (load.gravity && !problem_.skin_weight_n.empty()) force.z() -= problem_.skin_weight_n[node];
    for (int axis = 0; axis < 3; ++axis)
      if (problem_.fixed[node][axis]) force[axis] = 0;
    return force;
  }

  // The terms of one load case; none where nothing acts.
  void add_case(int k) {
    if (!request_.responses[k].in_equilibrium) return;  // no field to start from
    const int load_case = request_.load_cases[k];
    const bool gravity = problem_.load_cases[load_case].gravity;
    const double half_weight = gravity ? problem_.material.weight_density_n_mm3() / 2 : 0.0;
    const int slot = static_cast<int>(out_.load_cases.size());
    std::vector<RelaxedTerm> terms;
    if (problem_.displacement_limit_mm) {
      const double epsilon = (1 + request_.feasibility_tolerance) * *problem_.displacement_limit_mm;
      RelaxedTerm term{TermKind::kDisplacement, slot, -1, 0, VectorXd::Zero(struts_), 1};
      for (std::size_t i = 0; i < problem_.frame.nodes_mm.size(); ++i)
        term.constant -= epsilon * external_n(load_case, static_cast<int>(i)).norm();
      for (int j = 0; j < struts_; ++j)
        for (int i : {problem_.frame.struts[j].a, problem_.frame.struts[j].b})
          if (!problem_.fixed[i][2]) term.slope[j] -= epsilon * half_weight * length(j);
      terms.push_back(std::move(term));
    }
    if (const double density = allowed_energy_density_mpa(problem_, request_.feasibility_tolerance);
        std::isfinite(density)) {
      RelaxedTerm term{TermKind::kStress, slot, -1, 0, VectorXd::Zero(struts_), 1};
      for (int j = 0; j < struts_; ++j) term.slope[j] = -density * length(j);
      if (terms.empty() || allowed(term) < kStressMatters * allowed(terms[0]))
        terms.push_back(std::move(term));
    }
    if (terms.empty() || !(allowed(terms[0]) > 0)) return;
    out_.load_cases.push_back(load_case);
    out_.gravity.push_back(gravity ? 1.0 : 0.0);
    if (energy_unit_ == 0) energy_unit_ = allowed(terms[0]) / struts_;
    for (RelaxedTerm& term : terms) add(std::move(term), energy_unit_);
  }

  double allowed(const RelaxedTerm& term) const {
    return -term.constant - term.slope.dot(VectorXd::Map(request_.start_mm2.data(), struts_));
  }

  void add(RelaxedTerm term, double unit) {
    term.unit = unit;
    term.constant /= unit;
    term.slope *= out_.area_mm2 / unit;
    out_.terms.push_back(std::move(term));
  }

  void set_loads() {
    const StrutSprings springs = strut_springs(problem_.element, problem_.material);
    const double d = out_.displacement_mm, energy = energy_unit_ > 0 ? energy_unit_ : 1.0;
    out_.half_weight.resize(struts_);
    for (int j = 0; j < struts_; ++j) {
      const Strut& strut = problem_.frame.struts[j];
      const Vector3d e = problem_.frame.nodes_mm[strut.b] - problem_.frame.nodes_mm[strut.a];
      out_.stiffness.push_back(out_.area_mm2 * d * d / energy * strut_stiffness(springs, e));
      out_.half_weight[j] = springs.half_weight * e.norm() * out_.area_mm2 * d / energy;
    }
    const int nodes = static_cast<int>(problem_.frame.nodes_mm.size()), cases = out_.case_count();
    out_.external.resize(3 * cases * nodes);
    for (int i = 0; i < nodes; ++i)
      for (int k = 0; k < cases; ++k)
        out_.external.segment<3>(3 * (cases * i + k)) = d / energy * external_n(out_.load_cases[k], i);
  }

  void add_balance(int plane) {
    const HalfPlane& edge = problem_.balance[plane];
    const double offset = edge.offset_mm + request_.feasibility_tolerance;
    const FixedMass& skin = problem_.skin_mass;
    RelaxedTerm term{TermKind::kBalance, -1, plane, 0, VectorXd::Zero(struts_), 1};
    term.constant = skin.weight_n * (edge.normal.dot(skin.centroid_mm.head<2>()) - offset);
    double unit = std::abs(term.constant);
    for (int j = 0; j < struts_; ++j) {
      const Strut& strut = problem_.frame.struts[j];
      const Vector3d middle = (problem_.frame.nodes_mm[strut.a] + problem_.frame.nodes_mm[strut.b]) / 2;
      term.slope[j] =
          problem_.material.weight_density_n_mm3() * length(j) * (edge.normal.dot(middle.head<2>()) - offset);
      unit += std::abs(term.slope[j]) * request_.start_mm2[j];
    }
    if (unit > 0) add(std::move(term), unit / struts_);
  }

  const FrameProblem& problem_;
  const RelaxationRequest& request_;
  const int struts_;
  Relaxation out_;
  double energy_unit_ = 0;
};

}  // namespace

Relaxation relax(const FrameProblem& problem, const AreaBox& box, const RelaxationRequest& request) {
  return Builder(problem, box, request).take();
}

DualForm dual_form(const Relaxation& p, const SaddlePoint& point) {
  const int cases = p.case_count();
  DualForm form{2 * p.external.dot(point.fields), VectorXd::Zero(p.strut_count())};
  VectorXd weight = VectorXd::Zero(cases);
  for (int c = 0; c < p.term_count(); ++c) {
    form.constant += point.multipliers[c] * p.terms[c].constant;
    form.slope += point.multipliers[c] * p.terms[c].slope;
    if (p.terms[c].load_case >= 0) weight[p.terms[c].load_case] += point.multipliers[c];
  }
  for (int j = 0; j < p.strut_count(); ++j)
    for (int k = 0; k < cases; ++k) {
      const auto a = point.fields.segment<3>(3 * (cases * p.struts[j].first + k));
      const auto b = point.fields.segment<3>(3 * (cases * p.struts[j].second + k));
      const Vector3d delta = b - a;
      form.slope[j] -= 2 * p.gravity[k] * p.half_weight[j] * (a.z() + b.z()) +
                       delta.dot(p.stiffness[j] * delta) / weight[k];
    }
  return form;
}

double least_over_box(const Relaxation& p, const DualForm& form, double scale) {
  double least = scale * form.constant;
  for (int j = 0; j < p.strut_count(); ++j) {
    const double slope = p.cost[j] + scale * form.slope[j];
    least += slope * (slope >= 0 ? p.lower[j] : p.upper[j]);
  }
  return least;
}

std::pair<double, double> best_scale(const Relaxation& p, const DualForm& form) {
  // The derivative in the scale at s falls with s: bisection on its sign, in powers first.
  const auto rising = [&](double scale) {
    double derivative = form.constant;
    for (int j = 0; j < p.strut_count(); ++j)
      derivative += form.slope[j] * (p.cost[j] + scale * form.slope[j] >= 0 ? p.lower[j] : p.upper[j]);
    return derivative > 0;
  };
  double low = 0, high = 1;
  while (rising(high) && high < kMostScale) low = high, high *= 2;
  for (int step = 0; step < kScaleSteps && high - low > 1e-12 * high; ++step) {
    const double middle = (low + high) / 2;
    (rising(middle) ? low : high) = middle;
  }
  const double at_low = least_over_box(p, form, low), at_high = least_over_box(p, form, high);
  return at_low >= at_high ? std::pair(low, at_low) : std::pair(high, at_high);
}

DualProof proof_of(const Relaxation& p, const SaddlePoint& point, double scale, std::size_t half_planes) {
  DualProof proof;
  proof.volume_weight = p.volume_weight;
  proof.feasibility_tolerance = p.feasibility_tolerance;
  const int cases = p.case_count();
  const int nodes = static_cast<int>(p.fixed.size());
  proof.fields.resize(cases);
  for (int k = 0; k < cases; ++k) proof.fields[k].load_case = p.load_cases[k];
  VectorXd weight = VectorXd::Zero(cases);
  for (int c = 0; c < p.term_count(); ++c) {
    const RelaxedTerm& term = p.terms[c];
    const double multiplier = scale * point.multipliers[c] * p.volume_mm3 / term.unit;
    switch (term.kind) {
      case TermKind::kDisplacement:
        proof.fields[term.load_case].displacement_multiplier = multiplier;
        weight[term.load_case] += point.multipliers[c];
        break;
      case TermKind::kStress:
        proof.fields[term.load_case].stress_multiplier = multiplier;
        weight[term.load_case] += point.multipliers[c];
        break;
      case TermKind::kBalance:
        if (proof.balance_multipliers.empty()) proof.balance_multipliers.assign(half_planes, 0);
        proof.balance_multipliers[term.half_plane] = multiplier;
        break;
    }
  }
  for (int k = 0; k < cases; ++k)
    for (int i = 0; i < nodes; ++i)
      proof.fields[k].displacements_mm.push_back(p.displacement_mm / weight[k] *
                                                 point.fields.segment<3>(3 * (cases * i + k)));
  return proof;
}

}  // namespace skinframe
