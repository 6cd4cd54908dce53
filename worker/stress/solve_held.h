// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

#include "worker/run/result.h"
#include "worker/run/run_context.h"

namespace skinframe {

// Solves K u = f by Cholesky factors (CHOLMOD, supernodal), a column a load case. Entries: the lower triangle
// of K, repeated ones are added. Errors: kInvalidInput when K is not positive definite, as of a body that its
// supports do not hold; kCancelled.
Result<Eigen::MatrixXd> solve_held(std::vector<Eigen::Triplet<double>> entries, const Eigen::MatrixXd& f,
                                   const RunContext& context);

}  // namespace skinframe
