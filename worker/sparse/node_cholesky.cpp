// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/sparse/node_cholesky.h"

#include <Eigen/CholmodSupport>
#include <algorithm>
#include <new>

#include "worker/run/ordering_turn.h"
#include "worker/run/result.h"

namespace skinframe {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Matrix = NodeMatrix::Matrix;

// CHOLMOD takes three copies of the right sides beside the factor: of some columns at a time, which are
// enough for it to multiply blocks.
constexpr Eigen::Index kColumnsAtOnce = 16;

// The lower half of the graph of nodes, as a pattern.
Matrix graph_of(const NodeMatrix& k) {
  Matrix graph(k.node_count(), k.node_count());
  for (int v = 0; v < k.node_count(); ++v) {
    graph.startVec(v);
    for (const int w : k.linked_from(v)) graph.insertBack(w, v) = 1;
  }
  graph.finalize();
  return graph;
}

}  // namespace

// Eigen's wrapper orders by itself and solves by the whole factor; here the order is given, and either half
// solves by itself.
class NodeCholesky::Factor : public Eigen::CholmodSupernodalLLT<Matrix, Eigen::Lower> {
 public:
  bool compute(const NodeMatrix& matrix) {
    cholmod().print = 0;  // failure is a return value, not a line on the terminal
    std::vector<int> order = order_rows(matrix);
    cholmod().nmethods = 1;
    cholmod().method[0].ordering = CHOLMOD_GIVEN;
    cholmod_sparse k = Eigen::viewAsCholmod(matrix.lower().selfadjointView<Eigen::Lower>());
    m_cholmodFactor = cholmod_analyze_p(&k, order.data(), nullptr, 0, &cholmod());
    if (m_cholmodFactor == nullptr) throw std::bad_alloc();
    m_isInitialized = true;
    m_analysisIsOk = true;
    factorize(matrix.lower());
    if (cholmod().status < CHOLMOD_OK) throw std::bad_alloc();  // Eigen takes a factor without values for one
    return info() == Eigen::Success;
  }

  VectorXd solve_part(int system, VectorXd x) {
    cholmod_dense right = Eigen::viewAsCholmod(x);
    cholmod_dense* solved = cholmod_solve(system, m_cholmodFactor, &right, &cholmod());
    if (solved == nullptr) throw std::bad_alloc();
    x = VectorXd::Map(static_cast<const double*>(solved->x), x.size());
    cholmod_free_dense(&solved, &cholmod());
    return x;
  }

 private:
  std::vector<int> order_rows(const NodeMatrix& matrix) {
    const Matrix graph = graph_of(matrix);
    cholmod_sparse pattern = Eigen::viewAsCholmod(graph.selfadjointView<Eigen::Lower>());
    std::vector<int> nodes(graph.rows());
    {
      const OrderingTurn turn;
      if (!cholmod_metis(&pattern, nullptr, 0, false, nodes.data(), &cholmod())) throw std::bad_alloc();
    }
    std::vector<int> rows;
    rows.reserve(matrix.rows());
    for (const int v : nodes)
      for (int r = matrix.first_row(v); r < matrix.first_row(v + 1); ++r) rows.push_back(r);
    return rows;
  }
};

NodeCholesky::NodeCholesky(std::unique_ptr<Factor> factor) : factor_(std::move(factor)) {}
NodeCholesky::~NodeCholesky() = default;
NodeCholesky::NodeCholesky(NodeCholesky&&) noexcept = default;
NodeCholesky& NodeCholesky::operator=(NodeCholesky&&) noexcept = default;

std::optional<NodeCholesky> NodeCholesky::factorise(const NodeMatrix& k) {
  auto factor = std::make_unique<Factor>();
  if (k.rows() > 0 && !factor->compute(k)) return std::nullopt;
  return NodeCholesky(std::move(factor));
}

void NodeCholesky::solve_in_place(MatrixXd* x) const {
  if (x->rows() == 0) return;
  for (Eigen::Index at = 0; at < x->cols(); at += kColumnsAtOnce) {
    auto some = x->middleCols(at, std::min(kColumnsAtOnce, x->cols() - at));
    some = MatrixXd(factor_->solve(MatrixXd(some)));
    if (factor_->info() != Eigen::Success) throw std::bad_alloc();  // what it gave is whatever was there
  }
}
VectorXd NodeCholesky::half_solve(const VectorXd& x) const {
  return factor_->solve_part(CHOLMOD_L, factor_->solve_part(CHOLMOD_P, x));
}
VectorXd NodeCholesky::other_half_solve(const VectorXd& x) const {
  return factor_->solve_part(CHOLMOD_Pt, factor_->solve_part(CHOLMOD_Lt, x));
}

}  // namespace skinframe
