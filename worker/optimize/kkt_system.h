// SPDX-License-Identifier: GPL-3.0-or-later
// The Newton step of the barrier problem (Nocedal and Wright 2006, section 19.3), solved through the frame's
// structure:
//
//  1. Slacks and duals of all inequalities but the dense rows are condensed: Sigma = z / s weighs their
//  squares.
//  2. The Hessian in A is diagonal: each A_j is eliminated within its strut. What is left couples only nodes
//  that share a
//     strut: one dense block a node, [d of each case | lambda of each case | x where it moves], factorised by
//     BlockLdlt.
//  3. The dense rows and the elastic scalar t border it: a Schur complement of a few rows.
//
// The step is a descent direction for the barrier when the inertia is (primal, dual, 0): factorise() says
// whether it is.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "worker/optimize/block_ldlt.h"
#include "worker/optimize/frame_program.h"
#include "worker/optimize/iterate.h"

namespace skinframe {

struct Regularisation {
  double primal = 0;  // added to the Hessian's diagonal
  double dual = 0;    // subtracted on the diagonal of the equilibrium rows
};

// The duals of the dense rows come out of the linear system itself. Recovered from their slacks they would be
// lost to rounding: c sums over all struts, and z / s of an active row is huge.
struct KktStep {
  ProgramVector point;
  Eigen::VectorXd row_duals;
};

class KktSystem {
 public:
  KktSystem(const FrameProgram& program, const InequalityLayout& layout);  // both must outlive it

  void assemble(const Iterate& iterate, double barrier, const Regularisation& regularisation);
  bool factorise();       // false: singular, or the wrong inertia
  KktStep solve() const;  // refined against the assembled matrix

 private:
  // One free axis of a node: its row in the node's block and the strut coordinates it moves, as
  // sign * coordinate[difference] + coordinate[sum] with sign -1 at end a, +1 at end b.
  struct Axis {
    int row, difference, sum;  // sum: -1 for none
  };
  struct StrutTerms {
    Eigen::MatrixXd hessian;   // in strut coordinates
    Eigen::VectorXd slope;     // d(dL/dA)/d(coordinates)
    Eigen::MatrixXd border;    // one column a dense row, and one for t
    Eigen::VectorXd row_area;  // derivative of each dense row with respect to A
    double curvature = 0;      // of A, with Sigma and regularisation
  };

  int coordinates(int strut) const;  // how many this strut has
  void add_equilibrium(int strut, const Iterate& iterate, StrutTerms& terms) const;
  void add_volume(int strut, double weight, const Iterate& iterate, StrutTerms& terms) const;
  void add_strains(int strut, const Iterate& iterate, StrutTerms& terms);
  void add_geometry(int strut, const Iterate& iterate, StrutTerms& terms) const;
  void add_rows(int strut, const Iterate& iterate, StrutTerms& terms) const;
  void eliminate_area(int strut, const ProgramVector& gradient, StrutTerms& terms);
  void scatter(int strut, const StrutTerms& terms, const Eigen::VectorXd& right_hand_side);
  void add_nodes(const Iterate& iterate, const ProgramVector& gradient, const Regularisation& regularisation);
  void back_substitute(const Eigen::VectorXd& y, const Eigen::VectorXd& r, Eigen::VectorXd& nodes,
                       Eigen::VectorXd& border) const;
  Eigen::VectorXd strut_coordinates(int strut, const ProgramVector& step) const;

  const FrameProgram& program_;
  const InequalityLayout& layout_;
  std::vector<std::vector<Axis>> axes_;  // of each node
  std::vector<int> geometry_index_;      // of each strut in layout.geometry_struts, -1 for none
  std::vector<std::vector<int>> strains_of_;
  BlockLdlt matrix_;
  Inertia wanted_;
  int cases_, geometry_at_;  // first geometric strut coordinate: e, then x_a + x_b
  bool has_elastic_;
  StrutTerms scratch_;
  std::vector<Eigen::VectorXd> slopes_;  // kept for the areas' own step
  Eigen::VectorXd curvatures_, area_gradient_;
  Eigen::MatrixXd row_areas_;  // dense rows x struts
  Eigen::VectorXd right_hand_side_, border_right_;
  Eigen::MatrixXd border_, corner_;  // rows x (dense rows and t); square
  Eigen::MatrixXd solved_border_, schur_;
};

}  // namespace skinframe
