// SPDX-License-Identifier: GPL-3.0-or-later
// Factorising and solving what KktSystem has assembled.
#include "worker/optimize/kkt_system.h"

namespace skinframe {
namespace {

using Eigen::Infinity;
using Eigen::VectorXd;

constexpr int kRefinements = 2;
constexpr double kRefinedEnough = 1e-11;

// What takes the place of the duals when slacks and duals are condensed: mu / s + Sigma (c + s); z for
// the dense rows.
VectorXd condensed_duals(const FrameProgram& program, const InequalityLayout& layout, const Iterate& it,
                         double barrier) {
  const VectorXd c = inequalities(program, layout, it.point);
  VectorXd pulls = (barrier + it.duals.array() * (c + it.slacks).array()) / it.slacks.array();
  pulls.tail(layout.row_count) = it.duals.tail(layout.row_count);
  return pulls;
}

}  // namespace

bool KktSystem::factorise() {
  return matrix_.factorise() && rows_.factorise(matrix_) && matrix_.inertia() == wanted_;
}

void KktSystem::set_right_hand_side(const Iterate& it, double barrier) {
  const ProgramVector gradient =
      lagrangian_gradient(program_, layout_, it.point, condensed_duals(program_, layout_, it, barrier));
  right_hand_side_.resize(matrix_.rows());
  for (int i = 0; i < program_.node_count(); ++i) {
    const int first = matrix_.first_row(i);
    for (int k = 0; k < cases_; ++k) {
      right_hand_side_.segment<3>(first + 3 * k) = -gradient.displacements[k].col(i);
      right_hand_side_.segment<3>(first + 3 * (cases_ + k)) = -gradient.multipliers[k].col(i);
    }
    if (program_.moves[i]) right_hand_side_.segment<3>(first + 6 * cases_) = -gradient.positions.col(i);
  }
  area_gradient_ = gradient.areas;
  VectorXd sums = VectorXd::Zero(rows_.sums());
  for (int j = 0; j < program_.strut_count(); ++j) {
    if (program_.area_is_given(j)) continue;
    const double share = gradient.areas[j] / curvatures_[j];
    scatter_right(j, share * slopes_[j]);
    sums += share * sums_.col(j);
  }
  rows_.set_right_hand_side(it, barrier, gradient.elastic, sums);
}

void KktSystem::scatter_right(int j, const VectorXd& coordinates) {
  const auto [a, b] = program_.struts[j];
  for (const auto& [end, sign] : {std::pair{a, -1.0}, std::pair{b, 1.0}})
    for (const Axis& axis : axes_[end])
      right_hand_side_[matrix_.first_row(end) + axis.row] +=
          sign * coordinates[axis.difference] + (axis.sum >= 0 ? coordinates[axis.sum] : 0.0);
}

KktStep KktSystem::solve(const Iterate& it, double barrier) {
  set_right_hand_side(it, barrier);
  const auto solve_once = [this](const VectorXd& y, const VectorXd& r, VectorXd& nodes, VectorXd& border) {
    nodes = y;
    matrix_.solve_in_place(nodes);
    rows_.complete(r, nodes, border);
  };
  const VectorXd right = rows_.right_hand_side();
  VectorXd nodes, border;
  solve_once(right_hand_side_, right, nodes, border);
  for (int pass = 0; pass < kRefinements; ++pass) {
    VectorXd y = right_hand_side_ - matrix_.multiply(nodes), r = right;
    rows_.subtract_from(nodes, border, y, r);
    if (y.size() == 0 || y.lpNorm<Infinity>() <= kRefinedEnough * (1 + right_hand_side_.lpNorm<Infinity>()))
      break;
    VectorXd more_nodes, more_border;
    solve_once(y, r, more_nodes, more_border);
    nodes += more_nodes;
    border += more_border;
  }
  return {step_of(nodes, border), rows_.duals(border)};
}

ProgramVector KktSystem::step_of(const VectorXd& nodes, const VectorXd& border) const {
  const int n = program_.node_count();
  ProgramVector step;
  step.positions = NodeMatrix::Zero(3, n);
  step.displacements.assign(cases_, NodeMatrix::Zero(3, n));
  step.multipliers = step.displacements;
  for (int i = 0; i < n; ++i) {
    const int first = matrix_.first_row(i);
    for (int k = 0; k < cases_; ++k) {
      step.displacements[k].col(i) = nodes.segment<3>(first + 3 * k);
      step.multipliers[k].col(i) = nodes.segment<3>(first + 3 * (cases_ + k));
    }
    if (program_.moves[i]) step.positions.col(i) = nodes.segment<3>(first + 6 * cases_);
  }
  step.elastic = rows_.elastic(border);
  step.areas = VectorXd::Zero(program_.strut_count());
  const VectorXd weights = rows_.sum_weights(border);
  VectorXd coordinates;
  for (int j = 0; j < program_.strut_count(); ++j) {
    if (program_.area_is_given(j)) continue;
    terms_of_.coordinates_of(j, step, coordinates);
    step.areas[j] =
        -(area_gradient_[j] + slopes_[j].dot(coordinates) + sums_.col(j).dot(weights)) / curvatures_[j];
  }
  return step;
}

}  // namespace skinframe
