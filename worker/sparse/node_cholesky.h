// SPDX-License-Identifier: GPL-3.0-or-later
// K X = F by Cholesky factors (CHOLMOD, supernodal), for a K whose rows belong to nodes: three or six
// freedoms each, coupled where an element joins their nodes. METIS orders the graph of nodes and not of
// freedoms (Karypis and Kumar 1998 call it compression): a ninth or a thirty-sixth of the edges, and the rows
// of a node stay together, which supernodes want.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "worker/sparse/node_matrix.h"

namespace skinframe {

class NodeCholesky {
 public:
  // None when K is not positive definite. Throws std::bad_alloc where memory does not do, as solving does.
  static std::optional<NodeCholesky> factorise(const NodeMatrix& k);
  ~NodeCholesky();
  NodeCholesky(NodeCholesky&&) noexcept;
  NodeCholesky& operator=(NodeCholesky&&) noexcept;

  void solve_in_place(Eigen::MatrixXd* x) const;
  Eigen::MatrixXd solve(Eigen::MatrixXd right_side) const {
    solve_in_place(&right_side);
    return right_side;
  }

  // The halves of K^-1 = H^T H: x <- H x and x <- H^T x. (H = L^-1 P, for the factor L of K with its rows and
  // columns in the order P.)
  Eigen::VectorXd half_solve(const Eigen::VectorXd& x) const;
  Eigen::VectorXd other_half_solve(const Eigen::VectorXd& x) const;

 private:
  class Factor;
  explicit NodeCholesky(std::unique_ptr<Factor> factor);
  std::unique_ptr<Factor> factor_;
};

}  // namespace skinframe
