// SPDX-License-Identifier: GPL-3.0-or-later
// The Newton step of the barrier problem (Nocedal and Wright 2006, section 19.3), solved through the frame's
// structure:
//
//  1. Slacks and duals of all inequalities but the dense rows are condensed: Sigma = z / s weighs their
//  squares.
//  2. The Hessian in A is diagonal: each A_j is eliminated within its strut (strut_terms). What is left
//  couples
//     only nodes that share a strut: one dense block a node, [d of each case | lambda of each case | x where
//     it moves], factorised by BlockLdlt.
//  3. The dense rows and the elastic scalar t border it (dense_rows).
//
// The step is a descent direction for the barrier when the inertia is (primal, dual, 0): factorise() says
// whether it is.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "worker/optimize/block_ldlt.h"
#include "worker/optimize/dense_rows.h"
#include "worker/optimize/frame_program.h"
#include "worker/optimize/iterate.h"
#include "worker/optimize/strut_terms.h"

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
  // Program and layout must outlive it. `team` and `cancelled` as for BlockLdlt.
  KktSystem(const FrameProgram& program, const InequalityLayout& layout,
            std::shared_ptr<ThreadTeam> team = nullptr, std::function<bool()> cancelled = {});

  void assemble(const Iterate& iterate, const Regularisation& regularisation);
  // False: singular, the wrong inertia, or cancelled. After the wrong inertia alone solve() still serves.
  bool factorise();
  // The Newton step towards this barrier from the iterate of assemble(), refined against the assembled
  // matrix.
  KktStep solve(const Iterate& iterate, double barrier);

 private:
  // One free axis of a node: its row in the node's block and the strut coordinates it moves, as
  // sign * coordinate[difference] + coordinate[sum] with sign -1 at end a, +1 at end b.
  struct Axis {
    int row, difference, sum;  // sum: -1 for none
  };

  void find_axes();
  void eliminate_area(int strut, StrutTerms& terms);
  void scatter(int strut, const StrutTerms& terms);
  void add_nodes(const Iterate& iterate, const Regularisation& regularisation);
  void add_displacement_limit(int load_case, int node, const Iterate& iterate);
  void hold_fixed_axes(int node);
  void add_half_spaces(const Iterate& iterate);
  void set_right_hand_side(const Iterate& iterate, double barrier);
  void scatter_right(int strut, const Eigen::VectorXd& coordinates);
  ProgramVector step_of(const Eigen::VectorXd& nodes, const Eigen::VectorXd& border) const;

  const FrameProgram& program_;
  const InequalityLayout& layout_;
  DenseRows rows_;
  StrutTermsOf terms_of_;
  std::vector<std::vector<Axis>> axes_;  // of each node
  BlockLdlt matrix_;
  Inertia wanted_;
  int cases_;
  StrutTerms scratch_;
  std::vector<Eigen::VectorXd> slopes_;  // of each strut, kept for its area's own step
  Eigen::VectorXd curvatures_, area_gradient_;
  Eigen::MatrixXd sums_;  // dense sums x struts
  Eigen::VectorXd right_hand_side_;
};

}  // namespace skinframe
