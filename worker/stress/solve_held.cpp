// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/stress/solve_held.h"

#include <Eigen/CholmodSupport>

#include "worker/run/ordering_turn.h"

namespace skinframe {

Result<Eigen::MatrixXd> solve_held(std::vector<Eigen::Triplet<double>> entries, const Eigen::MatrixXd& f,
                                   const RunContext& context) {
  Eigen::SparseMatrix<double> stiffness(f.rows(), f.rows());
  stiffness.setFromTriplets(entries.begin(), entries.end());
  std::vector<Eigen::Triplet<double>>().swap(entries);  // = {} would keep the memory, beside the factor's
  if (context.cancelled()) return cancelled_error();
  Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>, Eigen::Lower> solver;
  solver.cholmod().print = 0;
  {
    const OrderingTurn turn;
    solver.analyzePattern(stiffness);
  }
  solver.factorize(stiffness);
  if (solver.info() != Eigen::Success) return invalid_input("the tetrahedra are not held by their supports");
  if (context.cancelled()) return cancelled_error();
  Eigen::MatrixXd u = solver.solve(f);
  if (!u.allFinite()) return invalid_input("the tetrahedra are not held by their supports");
  return u;
}

}  // namespace skinframe
