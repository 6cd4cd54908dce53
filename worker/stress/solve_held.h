// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "worker/run/result.h"
#include "worker/run/run_context.h"
#include "worker/sparse/node_matrix.h"

namespace skinframe {

// Solves K u = f by Cholesky factors, a column a load case; f: a row a row of K. Takes both, so that neither
// lies beside what comes of it. Errors: kInvalidInput when K is not positive definite, as of a body that its
// supports do not hold; kCancelled.
Result<Eigen::MatrixXd> solve_held(NodeMatrix&& stiffness, Eigen::MatrixXd&& f, const RunContext& context);

}  // namespace skinframe
