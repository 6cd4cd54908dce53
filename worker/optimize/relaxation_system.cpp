// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/relaxation_system.h"

#include <algorithm>

namespace skinframe {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

// Between a strut's two ends, case after case, and full vectors.
template <class Column>
void scatter(const Relaxation& p, int strut, const VectorXd& column, double factor, Column&& full) {
  const int width = 3 * p.case_count();
  full.segment(width * p.struts[strut].first, width) += factor * column.head(width);
  full.segment(width * p.struts[strut].second, width) += factor * column.tail(width);
}

double gather(const Relaxation& p, int strut, const VectorXd& column, const VectorXd& full) {
  const int width = 3 * p.case_count();
  return column.head(width).dot(full.segment(width * p.struts[strut].first, width)) +
         column.tail(width).dot(full.segment(width * p.struts[strut].second, width));
}

}  // namespace

RelaxationSystem::RelaxationSystem(const Relaxation& relaxation, bool bounded_excess)
    : p_(relaxation),
      bounded_excess_(bounded_excess),
      cases_(relaxation.case_count()),
      terms_(relaxation.term_count()),
      struts_(relaxation.strut_count()),
      cholesky_(relaxation.struts, relaxation.fixed, std::max(1, relaxation.case_count())) {}

// The derivative of the gradient in A_j by w, at the strut's two ends.
VectorXd RelaxationSystem::coupling(const RelaxationValues& values, int j) const {
  VectorXd column(6 * cases_);
  for (int k = 0; k < cases_; ++k) {
    const Vector3d weight(0, 0, -p_.gravity[k] * p_.half_weight[j]);
    column.segment<3>(3 * k) = 2 * (weight + values.pulls[k].col(j));
    column.segment<3>(3 * (cases_ + k)) = 2 * (weight - values.pulls[k].col(j));
  }
  return column;
}

double RelaxationSystem::term_coupling(const RelaxationValues& values, int c, int j) const {
  const int k = p_.terms[c].load_case;
  return p_.terms[c].slope[j] + (k >= 0 ? values.energies(j, k) : 0.0);
}

void RelaxationSystem::clear_fixed(Eigen::Ref<MatrixXd> rows) const {
  if (cases_ == 0) return;
  for (int i = 0; i < static_cast<int>(p_.fixed.size()); ++i)
    for (int row = 0; row < 3 * cases_; ++row)
      if (p_.fixed[i][row % 3]) rows.row(3 * cases_ * i + row).setZero();
}

// What the terms' own rows have beside the eliminated areas.
void RelaxationSystem::border_terms(const RelaxationIterate& at, const RelaxationValues& values) {
  for (int c = 0; c < terms_; ++c) {
    const int k = p_.terms[c].load_case;
    corner_(c, c) += at.slacks[c] / at.point.multipliers[c];
    if (k < 0) continue;
    for (int i = 0; i < static_cast<int>(p_.fixed.size()); ++i) {
      const int at_node = 3 * (cases_ * i + k);
      border_.col(c).segment<3>(at_node) -= 2 / values.weights[k] * values.internal.segment<3>(at_node);
    }
    for (int d = 0; d < terms_; ++d)
      if (p_.terms[d].load_case == k) corner_(c, d) += 2 * values.stored[k] / values.weights[k];
  }
  if (bounded_excess_) corner_ += at.excess_bound / at.excess_slack * MatrixXd::Ones(terms_, terms_);
}

bool RelaxationSystem::factorise(const RelaxationIterate& at, const RelaxationValues& values) {
  flexibility_ = VectorXd::Zero(struts_);
  for (int j = 0; j < struts_; ++j)
    if (!p_.area_is_given(j))
      flexibility_[j] = 1 / (at.below_dual[j] / (at.point.areas[j] - p_.lower[j]) +
                             at.above_dual[j] / (p_.upper[j] - at.point.areas[j]));
  cholesky_.clear();
  border_ = MatrixXd::Zero(p_.external.size(), terms_);
  corner_ = MatrixXd::Zero(terms_, terms_);
  MatrixXd block(6 * cases_, 6 * cases_);
  VectorXd terms(terms_);
  for (int j = 0; j < struts_; ++j) {
    const VectorXd column = coupling(values, j);
    block.noalias() = flexibility_[j] * column * column.transpose();
    for (int k = 0; k < cases_; ++k) {
      const Eigen::Matrix3d stiffness = 2 * at.point.areas[j] / values.weights[k] * p_.stiffness[j];
      const int a = 3 * k, b = 3 * (cases_ + k);
      block.block<3, 3>(a, a) += stiffness;
      block.block<3, 3>(b, b) += stiffness;
      block.block<3, 3>(a, b) -= stiffness;
      block.block<3, 3>(b, a) -= stiffness;
    }
    if (cases_ > 0) cholesky_.add(j, block);
    for (int c = 0; c < terms_; ++c) {
      terms[c] = term_coupling(values, c, j);
      if (cases_ > 0) scatter(p_, j, column, flexibility_[j] * terms[c], border_.col(c));
    }
    corner_.noalias() += flexibility_[j] * terms * terms.transpose();
  }
  border_terms(at, values);
  clear_fixed(border_);
  if (cases_ > 0 && !cholesky_.factorise()) return false;
  solved_border_ = border_;
  for (int c = 0; cases_ > 0 && c < terms_; ++c) solved_border_.col(c) = cholesky_.solve(border_.col(c));
  schur_.compute(corner_ - border_.transpose() * solved_border_);
  return schur_.info() == Eigen::Success;
}

RelaxationIterate RelaxationSystem::step(const RelaxationIterate& at, const RelaxationValues& values,
                                         double barrier) const {
  VectorXd force = 2 * (values.forces - values.internal);
  VectorXd terms = values.excess + barrier * at.point.multipliers.cwiseInverse();
  if (bounded_excess_) terms.array() -= barrier / at.excess_slack;
  VectorXd residual = VectorXd::Zero(struts_);
  for (int j = 0; j < struts_; ++j) {
    if (p_.area_is_given(j)) continue;
    residual[j] = values.gradient[j] - barrier / (at.point.areas[j] - p_.lower[j]) +
                  barrier / (p_.upper[j] - at.point.areas[j]);
    if (cases_ > 0) scatter(p_, j, coupling(values, j), -flexibility_[j] * residual[j], force);
    for (int c = 0; c < terms_; ++c) terms[c] -= term_coupling(values, c, j) * flexibility_[j] * residual[j];
  }
  clear_fixed(force);
  const VectorXd loose = cases_ > 0 ? cholesky_.solve(force) : force;
  RelaxationIterate step;
  step.point.multipliers = schur_.solve(terms - border_.transpose() * loose);
  step.point.fields = loose - solved_border_ * step.point.multipliers;
  step.point.areas = VectorXd::Zero(struts_);
  for (int j = 0; j < struts_; ++j) {
    if (p_.area_is_given(j)) continue;
    double pull = cases_ > 0 ? gather(p_, j, coupling(values, j), step.point.fields) : 0.0;
    for (int c = 0; c < terms_; ++c) pull += term_coupling(values, c, j) * step.point.multipliers[c];
    step.point.areas[j] = -flexibility_[j] * (residual[j] + pull);
  }
  step_duals(at, barrier, &step);
  return step;
}

// From the step in the areas and multipliers, by the linearised products.
void RelaxationSystem::step_duals(const RelaxationIterate& at, double barrier,
                                  RelaxationIterate* step) const {
  step->below_dual = step->above_dual = VectorXd::Zero(struts_);
  for (int j = 0; j < struts_; ++j) {
    if (p_.area_is_given(j)) continue;
    const double below = at.point.areas[j] - p_.lower[j], above = p_.upper[j] - at.point.areas[j];
    step->below_dual[j] = (barrier - at.below_dual[j] * step->point.areas[j]) / below - at.below_dual[j];
    step->above_dual[j] = (barrier + at.above_dual[j] * step->point.areas[j]) / above - at.above_dual[j];
  }
  step->slacks =
      (barrier - at.slacks.array() * step->point.multipliers.array()) / at.point.multipliers.array() -
      at.slacks.array();
  if (!bounded_excess_) return;
  step->excess_slack = -step->point.multipliers.sum();
  step->excess_bound = (barrier - at.excess_bound * step->excess_slack) / at.excess_slack - at.excess_bound;
}

}  // namespace skinframe
