// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <functional>

#include "worker/run/result.h"
#include "worker/run/run_context.h"
#include "worker/sparse/node_matrix.h"

namespace skinframe {

// Solves K u = f by Cholesky factors, a column a load case; right_side gives f, a row a row of K, when K is
// factorised and gone: neither lies beside the factor's making. Errors: kInvalidInput when K is not positive
// definite, as of a body that its supports do not hold; kCancelled.
Result<Eigen::MatrixXd> solve_held(NodeMatrix&& stiffness, const std::function<Eigen::MatrixXd()>& right_side,
                                   const RunContext& context);

}  // namespace skinframe
