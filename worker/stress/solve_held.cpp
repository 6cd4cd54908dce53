// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/stress/solve_held.h"

#include "worker/sparse/node_cholesky.h"

namespace skinframe {

Result<Eigen::MatrixXd> solve_held(NodeMatrix&& stiffness, const std::function<Eigen::MatrixXd()>& right_side,
                                   const RunContext& context) {
  if (context.cancelled()) return cancelled_error();
  std::optional<NodeCholesky> factor;
  {
    const NodeMatrix k = std::move(stiffness);
    factor = NodeCholesky::factorise(k);
  }
  if (!factor) return invalid_input("the tetrahedra are not held by their supports");
  if (context.cancelled()) return cancelled_error();
  Eigen::MatrixXd u = right_side();
  factor->solve_in_place(&u);
  if (!u.allFinite()) return invalid_input("the tetrahedra are not held by their supports");
  return u;
}

}  // namespace skinframe
