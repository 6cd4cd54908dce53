// SPDX-License-Identifier: GPL-3.0-or-later
// The inequalities that couple all struts, balance (8) and the volume cap (20), and the scalar t, as a border
// of the Newton system that stays narrow however many rows there are.
//
// For the edge n . x <= o of the base hull the moment is  n_x sum A l x + n_y sum A l y - o sum A l + skin,
// and the cap bounds sum A l: with S the (at most three) sums, row r reads  N_r . S + const <= 0, and its
// derivative is N_r times that of S. So the border  B N^T  has rank three, and one solve with three
// right-hand sides serves forty rows:
//
//   [ M          B E ] [ nodes    ]   [ y ]
//   [ E^T B^T     C  ] [ z_new, t ] = [ r ],     E = [ N^T 0; 0 1 ],     Schur complement  C - E^T (B^T M^-1
//   B) E
//
// with z_new the rows' duals after the step and C = -diag(s / z) less what the eliminated areas add.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>

#include "worker/optimize/block_ldlt.h"
#include "worker/optimize/frame_program.h"
#include "worker/optimize/iterate.h"

namespace skinframe {

class DenseRows {
 public:
  DenseRows(const FrameProgram& program, const InequalityLayout& layout);

  int sums() const { return static_cast<int>(weights_.cols()); }
  int rows() const { return static_cast<int>(weights_.rows()); }
  bool relaxed_limits() const { return program_.elastic == ElasticScope::kLimits; }
  int columns() const { return sums() + (relaxed_limits() ? 1 : 0); }  // of B
  int unknowns() const { return rows() + (has_elastic() ? 1 : 0); }

  // Sum q is sum A l factor(q, middle of the strut).
  double factor(int q, const Eigen::Vector3d& middle) const { return balanced_ && q < 2 ? middle[q] : 1.0; }
  Eigen::Vector3d factor_gradient(int q) const {
    return balanced_ && q < 2 ? Eigen::Vector3d(Eigen::Vector3d::Unit(q))
                              : Eigen::Vector3d(Eigen::Vector3d::Zero());
  }
  // The weights of the sums in the Lagrangian: N^T z.
  Eigen::VectorXd pull(const Iterate& iterate) const;

  // Starts a new system of so many rows, with what does not come from struts or nodes.
  void reset(int system_rows, const Iterate& iterate, double regularisation);
  Eigen::MatrixXd& border() { return border_; }  // B
  void add_elastic(double curvature) { elastic_curvature_ += curvature; }
  // An area goes out of the system: curvature h, derivatives of the sums.
  void eliminate_area(const Eigen::VectorXd& sums, double curvature);

  // False when the signs of the Schur complement are not (1 for t; one negative a row).
  bool factorise(const BlockLdlt& matrix);
  // `sums`: the sum over areas of the sums' derivatives times g / h.
  void set_right_hand_side(const Iterate& iterate, double barrier, double elastic_gradient,
                           const Eigen::VectorXd& sums);
  // From nodes = M^-1 y to the solution of the bordered system; `unknowns` are the new duals and t.
  void complete(const Eigen::VectorXd& right, Eigen::VectorXd& nodes, Eigen::VectorXd& unknowns) const;
  // What is left of the border's right-hand side and of the nodes' at a solution.
  Eigen::VectorXd right_hand_side() const { return right_; }
  void subtract_from(const Eigen::VectorXd& nodes, const Eigen::VectorXd& unknowns,
                     Eigen::VectorXd& node_rest, Eigen::VectorXd& rest) const;

  Eigen::VectorXd duals(const Eigen::VectorXd& unknowns) const { return unknowns.head(rows()); }
  double elastic(const Eigen::VectorXd& unknowns) const {
    return has_elastic() ? unknowns[unknowns.size() - 1] : 0.0;
  }
  // The rows' part in an area's own equation: sums . N^T z_new.
  Eigen::VectorXd sum_weights(const Eigen::VectorXd& unknowns) const {
    return weights_.transpose() * unknowns.head(rows());
  }

 private:
  bool has_elastic() const { return program_.elastic != ElasticScope::kNone; }
  Eigen::MatrixXd expand() const;  // E

  const FrameProgram& program_;
  const InequalityLayout& layout_;
  bool balanced_;
  Eigen::MatrixXd weights_;  // N: rows x sums
  Eigen::MatrixXd border_, solved_;
  Eigen::MatrixXd corner_;
  Eigen::MatrixXd eliminated_;  // sum over areas of sums sums^T / h
  double elastic_curvature_ = 0;
  Eigen::VectorXd right_;
  Eigen::FullPivLU<Eigen::MatrixXd> schur_;
};

}  // namespace skinframe
