// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/dual_proof.h"

#include <cmath>
#include <limits>

#include "worker/mechanics/strut_element.h"

namespace skinframe {
namespace {

using Eigen::Vector3d;

// S(A) = constant + slope . A, and the part of -S that the limits allow.
struct LinearForm {
  double constant = 0, allowed_constant = 0;
  std::vector<double> slope, allowed_slope;
};

Vector3d free_part(const std::array<bool, 3>& fixed, Vector3d v) {
  for (int axis = 0; axis < 3; ++axis)
    if (fixed[axis]) v[axis] = 0;
  return v;
}

void add_field(const FrameProblem& problem, const VirtualField& field, double tolerance, LinearForm& form) {
  const LoadCase& load = problem.load_cases[field.load_case];
  const double by_displacement = field.displacement_multiplier, by_stress = field.stress_multiplier;
  const double weight = by_displacement + by_stress;
  const double epsilon = by_displacement > 0 ? (1 + tolerance) * problem.displacement_limit_mm.value() : 0.0;
  const std::size_t nodes = problem.frame.nodes_mm.size();
  NodeVectors y(nodes);
  for (std::size_t i = 0; i < nodes; ++i) {
    y[i] = free_part(problem.fixed[i], field.displacements_mm[i]);
    Vector3d external = load.force_n[i];
    if (load.gravity && !problem.skin_weight_n.empty()) external.z() -= problem.skin_weight_n[i];
    external = free_part(problem.fixed[i], external);
    const double allowed = by_displacement * epsilon * external.norm();
    form.constant += 2 * weight * external.dot(y[i]) - allowed;
    form.allowed_constant += allowed;
  }
  const StrutSprings springs = strut_springs(problem.element, problem.material);
  const double density = by_stress > 0 ? allowed_energy_density_mpa(problem, tolerance) : 0.0;
  for (std::size_t j = 0; j < problem.frame.struts.size(); ++j) {
    const Strut& strut = problem.frame.struts[j];
    const Vector3d e = problem.frame.nodes_mm[strut.b] - problem.frame.nodes_mm[strut.a];
    const Vector3d delta = y[strut.b] - y[strut.a];
    const double l = e.norm();
    double work = -delta.dot(strut_stiffness(springs, e) * delta), allowed = by_stress * density * l;
    if (load.gravity) {
      const double half = springs.half_weight * l;
      work -= 2 * half * (y[strut.a].z() + y[strut.b].z());
      for (int i : {strut.a, strut.b})
        if (!problem.fixed[i][2]) allowed += by_displacement * epsilon * half;
    }
    form.slope[j] += weight * work - allowed;
    form.allowed_slope[j] += allowed;
  }
}

void add_balance(const FrameProblem& problem, const HalfPlane& plane, double multiplier, double tolerance,
                 LinearForm& form) {
  if (multiplier == 0) return;
  const double offset = plane.offset_mm + tolerance;
  const FixedMass& skin = problem.skin_mass;
  form.constant += multiplier * skin.weight_n * (plane.normal.dot(skin.centroid_mm.head<2>()) - offset);
  form.allowed_constant += multiplier * skin.weight_n;
  const double density = problem.material.weight_density_n_mm3();
  for (std::size_t j = 0; j < problem.frame.struts.size(); ++j) {
    const Strut& strut = problem.frame.struts[j];
    const Vector3d middle = (problem.frame.nodes_mm[strut.a] + problem.frame.nodes_mm[strut.b]) / 2;
    const double weight = multiplier * density * problem.frame.length_mm(strut);
    form.slope[j] += weight * (plane.normal.dot(middle.head<2>()) - offset);
    form.allowed_slope[j] += weight;
  }
}

}  // namespace

AreaBox area_box(const FrameProblem& problem, const std::vector<bool>& may_vanish) {
  AreaBox box;
  for (std::size_t j = 0; j < problem.frame.struts.size(); ++j) {
    const AreaBounds bounds = area_bounds(problem, static_cast<int>(j));
    box.lower_mm2.push_back(!may_vanish.empty() && may_vanish[j] ? 0.0 : bounds.lower_mm2);
    box.upper_mm2.push_back(bounds.upper_mm2);
  }
  return box;
}

double allowed_energy_density_mpa(const FrameProblem& problem, double feasibility_tolerance) {
  const Material& m = problem.material;
  const double infinite = std::numeric_limits<double>::infinity();
  const double room = (1 + feasibility_tolerance) * (1 + feasibility_tolerance);
  if (!m.tensile_strength_mpa) return infinite;
  const double axial = room * *m.tensile_strength_mpa * *m.tensile_strength_mpa / m.tensile_modulus_mpa;
  if (problem.element == ElementModel::kAxial) return axial;
  if (!m.shear_strength_mpa) return infinite;
  return axial + room * *m.shear_strength_mpa * *m.shear_strength_mpa / m.shear_modulus_mpa;
}

DualValue dual_value(const FrameProblem& problem, const AreaBox& box, const DualProof& proof) {
  const std::size_t struts = problem.frame.struts.size();
  LinearForm form;
  form.slope.assign(struts, 0);
  form.allowed_slope.assign(struts, 0);
  for (const VirtualField& field : proof.fields) add_field(problem, field, proof.feasibility_tolerance, form);
  for (std::size_t r = 0; r < proof.balance_multipliers.size(); ++r)
    add_balance(problem, problem.balance[r], proof.balance_multipliers[r], proof.feasibility_tolerance, form);

  DualValue out{form.constant, form.allowed_constant};
  for (std::size_t j = 0; j < struts; ++j) {
    const double slope =
        proof.volume_weight * problem.frame.length_mm(problem.frame.struts[j]) + form.slope[j];
    const double area = slope >= 0 ? box.lower_mm2[j] : box.upper_mm2[j];
    out.value += slope * area;
    out.normalisation += form.allowed_slope[j] * area;
  }
  return out;
}

}  // namespace skinframe
