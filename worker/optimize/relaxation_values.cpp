// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/relaxation_values.h"

#include <algorithm>

namespace skinframe {

using Eigen::Vector3d;
using Eigen::VectorXd;

double RelaxationValues::worst_force() const {
  if (forces.size() == 0) return 0.0;
  return (forces - internal).lpNorm<Eigen::Infinity>() / std::max(forces.lpNorm<Eigen::Infinity>(), 1e-300);
}

double case_weight(const Relaxation& relaxation, const SaddlePoint& point, int load_case) {
  double weight = 0;
  for (int c = 0; c < relaxation.term_count(); ++c)
    if (relaxation.terms[c].load_case == load_case) weight += point.multipliers[c];
  return weight;
}

void scale_cases(const Relaxation& relaxation, const VectorXd& factors, VectorXd* full) {
  const int cases = relaxation.case_count();
  for (int i = 0; i < static_cast<int>(relaxation.fixed.size()); ++i)
    for (int k = 0; k < cases; ++k) full->segment<3>(3 * (cases * i + k)) *= factors[k];
}

RelaxationValues relaxation_values(const Relaxation& p, const SaddlePoint& point) {
  const int cases = p.case_count(), terms = p.term_count(), struts = p.strut_count();
  RelaxationValues v;
  v.weights.resize(cases);
  for (int k = 0; k < cases; ++k) v.weights[k] = case_weight(p, point, k);
  v.displacements = point.fields;
  scale_cases(p, v.weights.cwiseInverse(), &v.displacements);
  v.pulls.assign(cases, Eigen::Matrix3Xd(3, struts));
  v.energies.resize(struts, cases);
  v.forces = p.external;
  v.internal = VectorXd::Zero(v.forces.size());
  for (int j = 0; j < struts; ++j) {
    const auto [a, b] = p.struts[j];
    for (int k = 0; k < cases; ++k) {
      const int at_a = 3 * (cases * a + k), at_b = 3 * (cases * b + k);
      const Vector3d delta = v.displacements.segment<3>(at_b) - v.displacements.segment<3>(at_a);
      const Vector3d pull = p.stiffness[j] * delta;
      v.pulls[k].col(j) = pull;
      v.energies(j, k) = delta.dot(pull);
      const double weight = p.gravity[k] * p.half_weight[j] * point.areas[j];
      v.forces[at_a + 2] -= weight;
      v.forces[at_b + 2] -= weight;
      v.internal.segment<3>(at_a) -= point.areas[j] * pull;
      v.internal.segment<3>(at_b) += point.areas[j] * pull;
    }
  }
  for (int i = 0; i < static_cast<int>(p.fixed.size()); ++i)
    for (int row = 0; row < 3 * cases; ++row)
      if (p.fixed[i][row % 3]) v.forces[3 * cases * i + row] = v.internal[3 * cases * i + row] = 0;
  v.stored = v.energies.transpose() * point.areas;
  v.excess.resize(terms);
  for (int c = 0; c < terms; ++c) {
    const RelaxedTerm& term = p.terms[c];
    v.excess[c] = term.constant + term.slope.dot(point.areas);
    if (term.load_case >= 0) v.excess[c] += v.stored[term.load_case];
  }
  v.gradient = p.cost + dual_form(p, point).slope;
  return v;
}

}  // namespace skinframe
