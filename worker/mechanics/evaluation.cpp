// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/mechanics/evaluation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace skinframe {
namespace {

using Eigen::Vector3d;

void add_response(const FrameProblem& problem, const std::vector<double>& radii_mm, int load_case,
                  const CaseResponse& response, Evaluation& evaluation) {
  evaluation.equilibrium_residual = std::max(evaluation.equilibrium_residual, response.residual);
  evaluation.in_equilibrium = evaluation.in_equilibrium && response.in_equilibrium;
  for (std::size_t i = 0; i < response.displacements_mm.size(); ++i) {
    const double moved = response.displacements_mm[i].norm();
    if (moved > evaluation.max_displacement_mm || evaluation.worst_node < 0) {
      evaluation.max_displacement_mm = moved;
      evaluation.worst_node = static_cast<int>(i);
      evaluation.worst_load_case = load_case;
    }
  }
  const auto worst = [&](const std::vector<double>& stress, const std::optional<double>& strength,
                         double& ratio, int& strut) {
    if (!strength) return;
    for (std::size_t j = 0; j < stress.size(); ++j) {
      if (radii_mm[j] < kVanishedRadiusMm) continue;
      const double here = std::abs(stress[j]) / *strength;
      if (here > ratio) {
        ratio = here;
        strut = static_cast<int>(j);
      }
    }
  };
  worst(response.axial_stress_mpa, problem.material.tensile_strength_mpa, evaluation.max_axial_ratio,
        evaluation.worst_axial_strut);
  worst(response.shear_stress_mpa, problem.material.shear_strength_mpa, evaluation.max_shear_ratio,
        evaluation.worst_shear_strut);
}

void add_radii(const FrameProblem& problem, const std::vector<double>& radii_mm, Evaluation& evaluation) {
  double thinnest = std::numeric_limits<double>::infinity();
  for (std::size_t j = 0; j < radii_mm.size(); ++j) {
    const double r = radii_mm[j];
    const AreaBounds area = area_bounds(problem, static_cast<int>(j));
    const double upper = std::sqrt(area.upper_mm2 / std::numbers::pi);
    evaluation.widened_struts += area.widened ? 1 : 0;
    evaluation.radius_violation_mm =
        std::max({evaluation.radius_violation_mm, r - upper, problem.bounds[j].min_mm - r});
    if (r < kVanishedRadiusMm) continue;
    thinnest = std::min(thinnest, r);
    if (problem.material.slenderness)
      evaluation.max_slenderness_ratio =
          std::max(evaluation.max_slenderness_ratio,
                   problem.frame.length_mm(problem.frame.struts[j]) / (*problem.material.slenderness * r));
  }
  evaluation.min_radius_mm = std::isfinite(thinnest) ? thinnest : 0;
  evaluation.frame_volume_mm3 = frame_volume_mm3(problem.frame, radii_mm);
}

void add_balance(const FrameProblem& problem, const std::vector<double>& radii_mm, Evaluation& evaluation) {
  const Frame& frame = problem.frame;
  double weight = problem.skin_mass.weight_n;
  Vector3d moment = weight * problem.skin_mass.centroid_mm;
  for (std::size_t j = 0; j < frame.struts.size(); ++j) {
    const Strut& strut = frame.struts[j];
    const double w = problem.material.weight_density_n_mm3() * std::numbers::pi * radii_mm[j] * radii_mm[j] *
                     frame.length_mm(strut);
    weight += w;
    moment += w * (frame.nodes_mm[strut.a] + frame.nodes_mm[strut.b]) / 2;
  }
  if (weight > 0) evaluation.centre_of_gravity_mm = moment / weight;
  evaluation.balance_margin_mm = std::numeric_limits<double>::infinity();
  for (const HalfPlane& edge : problem.balance)
    evaluation.balance_margin_mm =
        std::min(evaluation.balance_margin_mm,
                 edge.offset_mm - edge.normal.dot(evaluation.centre_of_gravity_mm.head<2>()));
}

}  // namespace

Evaluation evaluate(const FrameProblem& problem, const std::vector<double>& radii_mm,
                    const std::vector<CaseResponse>& responses) {
  Evaluation evaluation;
  for (std::size_t k = 0; k < responses.size(); ++k)
    add_response(problem, radii_mm, static_cast<int>(k), responses[k], evaluation);
  if (problem.displacement_limit_mm)
    evaluation.displacement_ratio = evaluation.max_displacement_mm / *problem.displacement_limit_mm;
  add_radii(problem, radii_mm, evaluation);
  add_balance(problem, radii_mm, evaluation);
  return evaluation;
}

Evaluation evaluate(const FrameProblem& problem, const std::vector<double>& radii_mm) {
  return evaluate(problem, radii_mm, solve_equilibrium(problem, areas_of(radii_mm)));
}

std::string violated_constraint(const Evaluation& e, double tolerance) {
  if (!e.in_equilibrium) return "equilibrium";
  const std::pair<const char*, double> ratios[] = {{"displacement", e.displacement_ratio},
                                                   {"axial stress", e.max_axial_ratio},
                                                   {"shear stress", e.max_shear_ratio},
                                                   {"slenderness", e.max_slenderness_ratio}};
  const auto worst = std::max_element(std::begin(ratios), std::end(ratios),
                                      [](const auto& a, const auto& b) { return a.second < b.second; });
  if (worst->second > 1 + tolerance) return worst->first;
  if (e.balance_margin_mm < -tolerance) return "balance";
  if (e.radius_violation_mm > tolerance) return "radius";
  return "";
}

double utilisation(const Evaluation& e) {
  if (!e.in_equilibrium) return std::numeric_limits<double>::infinity();
  return std::max({e.displacement_ratio, e.max_axial_ratio, e.max_shear_ratio});
}

}  // namespace skinframe
