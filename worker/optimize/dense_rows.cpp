// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/dense_rows.h"

#include <Eigen/Eigenvalues>

namespace skinframe {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

}  // namespace

DenseRows::DenseRows(const FrameProgram& program, const InequalityLayout& layout)
    : program_(program), layout_(layout), balanced_(!program.balance.empty()) {
  weights_ = MatrixXd::Zero(layout.row_count, balanced_ ? 3 : program.volume_cap ? 1 : 0);
  const int volume = sums() - 1;
  for (std::size_t r = 0; r < program.balance.size(); ++r) {
    const BalanceRow& row = program.balance[r];
    weights_.row(r) << row.scale * row.normal.x(), row.scale * row.normal.y(), -row.scale * row.offset;
  }
  if (program.volume_cap) weights_(layout.row_count - 1, volume) = program.cap_scale / *program.volume_cap;
}

VectorXd DenseRows::pull(const Iterate& it) const { return weights_.transpose() * it.duals.tail(rows()); }

MatrixXd DenseRows::expand() const {
  MatrixXd e = MatrixXd::Zero(columns(), unknowns());
  e.topLeftCorner(sums(), rows()) = weights_.transpose();
  if (relaxed_limits()) e(sums(), rows()) = 1;
  return e;
}

void DenseRows::reset(int system_rows, const Iterate& it, double regularisation) {
  border_ = MatrixXd::Zero(system_rows, columns());
  corner_ = MatrixXd::Zero(unknowns(), unknowns());
  eliminated_ = MatrixXd::Zero(sums(), sums());
  elastic_curvature_ = 0;
  for (int r = 0; r < rows(); ++r) corner_(r, r) = -it.slacks[layout_.rows + r] / it.duals[layout_.rows + r];
  if (!has_elastic()) return;
  const int t = rows();
  corner_(t, t) = regularisation;
  if (program_.elastic == ElasticScope::kBalance)
    for (std::size_t r = 0; r < program_.balance.size(); ++r) corner_(t, r) = corner_(r, t) = -1;
}

void DenseRows::eliminate_area(const VectorXd& sums, double curvature) {
  eliminated_.noalias() += sums * sums.transpose() / curvature;
}

void DenseRows::set_right_hand_side(const Iterate& it, double barrier, double elastic_gradient,
                                    const VectorXd& sums) {
  right_ = VectorXd::Zero(unknowns());
  if (unknowns() == 0) return;
  const VectorXd c = inequalities(program_, layout_, it.point);
  for (int r = 0; r < rows(); ++r) {
    const int i = layout_.rows + r;
    right_[r] = -c[i] - barrier / it.duals[i];
  }
  right_.head(rows()) += weights_ * sums;
  if (has_elastic()) right_[rows()] = -elastic_gradient;
}

bool DenseRows::factorise(const BlockLdlt& matrix) {
  if (unknowns() == 0) return true;
  corner_.topLeftCorner(rows(), rows()) -= weights_ * eliminated_ * weights_.transpose();
  if (has_elastic()) corner_(rows(), rows()) += elastic_curvature_;
  solved_ = border_;
  if (columns() > 0) matrix.solve_in_place(solved_);
  const MatrixXd e = expand(), schur = corner_ - e.transpose() * (border_.transpose() * solved_) * e;
  if (!schur.allFinite()) return false;
  const VectorXd eigenvalues =
      Eigen::SelfAdjointEigenSolver<MatrixXd>(schur, Eigen::EigenvaluesOnly).eigenvalues();
  schur_.compute(schur);
  return (eigenvalues.array() < 0).count() == rows() &&
         (eigenvalues.array() > 0).count() == (has_elastic() ? 1 : 0);
}

void DenseRows::complete(const VectorXd& right, VectorXd& nodes, VectorXd& unknowns_found) const {
  if (unknowns() == 0) return;
  const MatrixXd e = expand();
  unknowns_found = schur_.solve(right - e.transpose() * (border_.transpose() * nodes));
  nodes -= solved_ * (e * unknowns_found);
}

void DenseRows::subtract_from(const VectorXd& nodes, const VectorXd& found, VectorXd& node_rest,
                              VectorXd& rest) const {
  if (unknowns() == 0) return;
  const MatrixXd e = expand();
  node_rest -= border_ * (e * found);
  rest -= e.transpose() * (border_.transpose() * nodes) + corner_ * found;
}

}  // namespace skinframe
