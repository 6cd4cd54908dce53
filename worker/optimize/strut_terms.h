// SPDX-License-Identifier: GPL-3.0-or-later
// What one strut adds to the Newton system, in its own coordinates, and its area eliminated from it.
//
// Strut coordinates: for each load case delta (3), eta (3) and s (1) as in strut_element.h; where an end
// moves, e (3) and x_a + x_b (3) after them. The Hessian in A is diagonal over struts: with curvature h,
// slope t = d(dL/dA)/dq and gradient g the area's row  h dA + t . dq = -g  goes out of the system as
//
//   H <- H - t t^T / h        and later        dA = -(g + t . dq + dense rows) / h
//
// Dense rows: every balance row and the volume cap is affine in sum A l x, sum A l y and sum A l, so that
// three columns carry any number of rows (dense_rows.h).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "worker/optimize/dense_rows.h"
#include "worker/optimize/frame_program.h"
#include "worker/optimize/iterate.h"

namespace skinframe {

inline constexpr int kCoordinatesPerCase = 7;

struct StrutTerms {
  Eigen::MatrixXd hessian;  // of the Lagrangian, with condensed inequalities
  Eigen::VectorXd slope;    // t
  Eigen::MatrixXd border;   // derivatives of the dense sums, and of the relaxed limits with respect to t
  Eigen::VectorXd sums;     // derivatives of the dense sums with respect to A
  double curvature = 0;     // h
  double elastic = 0;       // of t with itself
};

class StrutTermsOf {
 public:
  StrutTermsOf(const FrameProgram& program, const InequalityLayout& layout, const DenseRows& rows);

  int coordinates(int strut) const;
  int geometry_at() const { return geometry_at_; }

  // All terms of the strut but its area's elimination. `pull`: weights of the dense sums in the Lagrangian.
  void compute(int strut, const Iterate& iterate, const Eigen::VectorXd& pull, double regularisation,
               StrutTerms& terms) const;
  // The coordinates of the strut that a step moves, in the layout above.
  void coordinates_of(int strut, const ProgramVector& step, Eigen::VectorXd& coordinates) const;

 private:
  void add_equilibrium(int strut, const Iterate& iterate, StrutTerms& terms) const;
  void add_strains(int strut, const Iterate& iterate, StrutTerms& terms) const;
  void add_sums(int strut, const Iterate& iterate, const Eigen::VectorXd& pull, StrutTerms& terms) const;
  void add_shape(int strut, const Iterate& iterate, StrutTerms& terms) const;

  const FrameProgram& program_;
  const InequalityLayout& layout_;
  const DenseRows& rows_;
  int cases_, geometry_at_;
  std::vector<int> geometry_index_;  // of each strut in layout.geometry_struts, -1 for none
  std::vector<std::vector<int>> strains_of_;
};

}  // namespace skinframe
