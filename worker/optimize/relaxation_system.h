// SPDX-License-Identifier: GPL-3.0-or-later
// The Newton system of a relaxation's interior point. The Hessian in A is diagonal: each A_j is eliminated
// within its strut, and what is left is symmetric positive definite, with the pattern of K, bordered by one
// row a term. One Cholesky factorisation an iterate, any number of right sides.
#pragma once

#include <Eigen/Cholesky>

#include "worker/optimize/frame_cholesky.h"
#include "worker/optimize/relaxation_iterate.h"

namespace skinframe {

class RelaxationSystem {
 public:
  // bounded_excess: minimise the greatest excess of the terms in place of the cost.
  RelaxationSystem(const Relaxation& relaxation, bool bounded_excess);

  // False: not positive definite in floating point.
  bool factorise(const RelaxationIterate& at, const RelaxationValues& values);

  // The step from what was factorised last towards products of size `barrier`.
  RelaxationIterate step(const RelaxationIterate& at, const RelaxationValues& values, double barrier) const;

 private:
  Eigen::VectorXd coupling(const RelaxationValues& values, int strut) const;
  double term_coupling(const RelaxationValues& values, int term, int strut) const;
  void border_terms(const RelaxationIterate& at, const RelaxationValues& values);
  void clear_fixed(Eigen::Ref<Eigen::MatrixXd> rows) const;
  void step_duals(const RelaxationIterate& at, double barrier, RelaxationIterate* step) const;

  const Relaxation& p_;
  const bool bounded_excess_;
  const int cases_, terms_, struts_;
  FrameCholesky cholesky_;
  Eigen::VectorXd flexibility_;  // of each area: the inverse of its eliminated diagonal
  Eigen::MatrixXd border_, solved_border_, corner_;
  Eigen::LDLT<Eigen::MatrixXd> schur_;
};

}  // namespace skinframe
