// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/kkt_system.h"

namespace skinframe {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

std::vector<int> node_block_rows(const FrameProgram& program) {
  std::vector<int> rows(program.node_count());
  for (int i = 0; i < program.node_count(); ++i)
    rows[i] = 6 * program.case_count() + (program.moves[i] ? 3 : 0);
  return rows;
}

}  // namespace

KktSystem::KktSystem(const FrameProgram& program, const InequalityLayout& layout,
                     std::shared_ptr<ThreadTeam> team, std::function<bool()> cancelled)
    : program_(program),
      layout_(layout),
      rows_(program, layout),
      terms_of_(program, layout, rows_),
      axes_(program.node_count()),
      matrix_(node_block_rows(program), program.struts, std::move(team), std::move(cancelled)),
      cases_(program.case_count()),
      slopes_(program.strut_count()),
      curvatures_(program.strut_count()),
      sums_(rows_.sums(), program.strut_count()) {
  find_axes();
}

void KktSystem::find_axes() {
  const int geometry = terms_of_.geometry_at();
  for (int i = 0; i < program_.node_count(); ++i) {
    for (int k = 0; k < cases_; ++k)
      for (int axis = 0; axis < 3; ++axis) {
        if (program_.fixed[i][axis]) continue;
        const int at = kCoordinatesPerCase * k;
        axes_[i].push_back({3 * k + axis, at + axis, -1});
        axes_[i].push_back({3 * (cases_ + k) + axis, at + 3 + axis, axis == 2 ? at + 6 : -1});
      }
    for (int axis = 0; program_.moves[i] && axis < 3; ++axis)
      axes_[i].push_back({6 * cases_ + axis, geometry + axis, geometry + 3 + axis});
    wanted_.positive += 3 * cases_ + (program_.moves[i] ? 3 : 0);
    wanted_.negative += 3 * cases_;
  }
}

void KktSystem::assemble(const Iterate& it, const Regularisation& regularisation) {
  matrix_.set_zero();
  rows_.reset(matrix_.rows(), it, regularisation.primal);
  const VectorXd pull = rows_.pull(it);
  for (int j = 0; j < program_.strut_count(); ++j) {
    terms_of_.compute(j, it, pull, regularisation.primal, scratch_);
    eliminate_area(j, scratch_);
    scatter(j, scratch_);
  }
  add_nodes(it, regularisation);
  add_half_spaces(it);
}

void KktSystem::eliminate_area(int j, StrutTerms& terms) {
  slopes_[j] = terms.slope;
  curvatures_[j] = terms.curvature;
  sums_.col(j) = terms.sums;
  rows_.add_elastic(terms.elastic);
  if (program_.area_is_given(j)) return;
  const double inverse = 1 / terms.curvature;
  terms.hessian.noalias() -= inverse * terms.slope * terms.slope.transpose();
  terms.border.leftCols(rows_.sums()).noalias() -= inverse * terms.slope * terms.sums.transpose();
  rows_.eliminate_area(terms.sums, terms.curvature);
}

void KktSystem::scatter(int j, const StrutTerms& terms) {
  const int ends[2] = {program_.struts[j].first, program_.struts[j].second};
  const MatrixXd& h = terms.hessian;
  const auto entry = [&h](const Axis& r, double row_sign, const Axis& c, double column_sign) {
    double value = row_sign * column_sign * h(r.difference, c.difference);
    if (r.sum >= 0) value += column_sign * h(r.sum, c.difference);
    if (c.sum >= 0) value += row_sign * h(r.difference, c.sum);
    if (r.sum >= 0 && c.sum >= 0) value += h(r.sum, c.sum);
    return value;
  };
  for (int end = 0; end < 2; ++end) {
    const double sign = end == 0 ? -1 : 1;
    BlockLdlt::Block block = matrix_.node_block(ends[end]);
    const int first = matrix_.first_row(ends[end]);
    for (const Axis& c : axes_[ends[end]]) {
      for (const Axis& r : axes_[ends[end]]) block(r.row, c.row) += entry(r, sign, c, sign);
      for (Eigen::Index q = 0; q < terms.border.cols(); ++q)
        rows_.border()(first + c.row, q) +=
            sign * terms.border(c.difference, q) + (c.sum >= 0 ? terms.border(c.sum, q) : 0.0);
    }
  }
  BlockLdlt::Block block = matrix_.edge_block(j);
  for (const Axis& c : axes_[ends[1]])
    for (const Axis& r : axes_[ends[0]]) block(r.row, c.row) += entry(r, -1, c, 1);
}

void KktSystem::add_nodes(const Iterate& it, const Regularisation& regularisation) {
  for (int i = 0; i < program_.node_count(); ++i) {
    BlockLdlt::Block block = matrix_.node_block(i);
    for (int k = 0; k < cases_; ++k) {
      const int d = 3 * k, lambda = 3 * (cases_ + k);
      block.block<3, 3>(d, d) += regularisation.primal * Matrix3d::Identity();
      block.block<3, 3>(lambda, lambda) -= regularisation.dual * Matrix3d::Identity();
      if (program_.squared_displacement_limit) add_displacement_limit(k, i, it);
    }
    hold_fixed_axes(i);
    if (program_.moves[i])
      block.block<3, 3>(6 * cases_, 6 * cases_) += regularisation.primal * Matrix3d::Identity();
  }
}

void KktSystem::add_displacement_limit(int k, int i, const Iterate& it) {
  const int c = layout_.displacement_at(k, i, program_.node_count()), d = 3 * k;
  const double sigma = it.duals[c] / it.slacks[c], scale = 2 / *program_.squared_displacement_limit;
  const Vector3d slope = scale * it.point.displacements[k].col(i);
  matrix_.node_block(i).block<3, 3>(d, d) +=
      it.duals[c] * scale * Matrix3d::Identity() + sigma * slope * slope.transpose();
  if (!rows_.relaxed_limits()) return;
  rows_.border().block<3, 1>(matrix_.first_row(i) + d, rows_.sums()) -= sigma * slope;
  rows_.add_elastic(sigma);
}

// Displacement and multiplier of a fixed axis stay zero: +1 and -1 on the diagonal, nothing beside.
void KktSystem::hold_fixed_axes(int i) {
  BlockLdlt::Block block = matrix_.node_block(i);
  const int first = matrix_.first_row(i);
  for (int k = 0; k < cases_; ++k)
    for (int axis = 0; axis < 3; ++axis) {
      if (!program_.fixed[i][axis]) continue;
      for (const auto& [row, pivot] :
           {std::pair{3 * k + axis, 1.0}, std::pair{3 * (cases_ + k) + axis, -1.0}}) {
        block.row(row).setZero();
        block.col(row).setZero();
        block(row, row) = pivot;
        rows_.border().row(first + row).setZero();
      }
    }
}

void KktSystem::add_half_spaces(const Iterate& it) {
  for (std::size_t h = 0; h < program_.half_spaces.size(); ++h) {
    const NodeHalfSpace& space = program_.half_spaces[h];
    const int c = layout_.half_space + static_cast<int>(h);
    matrix_.node_block(space.node).block<3, 3>(6 * cases_, 6 * cases_) +=
        it.duals[c] / it.slacks[c] * space.normal * space.normal.transpose();
  }
}

}  // namespace skinframe
