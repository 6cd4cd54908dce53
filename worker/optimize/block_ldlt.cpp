// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/block_ldlt.h"

#include <algorithm>

extern "C" {
void dsytrf_(const char* uplo, const int* n, double* a, const int* lda, int* ipiv, double* work,
             const int* lwork, int* info);
void dsytrs_(const char* uplo, const int* n, const int* nrhs, const double* a, const int* lda,
             const int* ipiv, double* b, const int* ldb, int* info);
void dsytrs2_(const char* uplo, const int* n, const int* nrhs, double* a, const int* lda, const int* ipiv,
              double* b, const int* ldb, double* work, int* info);
void dgemm_(const char* transa, const char* transb, const int* m, const int* n, const int* k,
            const double* alpha, const double* a, const int* lda, const double* b, const int* ldb,
            const double* beta, double* c, const int* ldc);
void openblas_set_num_threads(int threads) __attribute__((weak));
}

namespace skinframe {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kWidthForLevel3 = 8;  // dsytrs2 pays from here on
constexpr int kUpdateColumns = 96;  // the symmetric update is done in column strips, lower part only

// dense(row.., column..) += block in the lower triangle of the front.
template <class Block>
void add_lower(MatrixXd& dense, int row, int column, const Block& block) {
  if (row >= column)
    dense.block(row, column, block.rows(), block.cols()) += block;
  else
    dense.block(column, row, block.cols(), block.rows()) += block.transpose();
}

}  // namespace

void use_one_blas_thread() {
  if (openblas_set_num_threads) openblas_set_num_threads(1);
}

BlockLdlt::BlockLdlt(std::vector<int> block_rows, std::vector<std::pair<int, int>> edges)
    : block_rows_(std::move(block_rows)),
      edges_(std::move(edges)),
      order_(order_blocks(block_rows_, edges_)) {
  first_row_.resize(block_rows_.size());
  for (int block : order_.block_at) {
    first_row_[block] = rows_;
    rows_ += block_rows_[block];
  }
  std::size_t values = 0;
  for (int rows : block_rows_) {
    node_start_.push_back(values);
    values += static_cast<std::size_t>(rows) * rows;
  }
  node_values_.resize(values);
  values = 0;
  edges_at_.resize(block_rows_.size());
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const auto [a, b] = edges_[e];
    edge_start_.push_back(values);
    values += static_cast<std::size_t>(block_rows_[a]) * block_rows_[b];
    edges_at_[std::min(order_.position[a], order_.position[b])].push_back(static_cast<int>(e));
  }
  edge_values_.resize(values);
  factors_.resize(order_.fronts.size());
}

void BlockLdlt::set_zero() {
  std::fill(node_values_.begin(), node_values_.end(), 0.0);
  std::fill(edge_values_.begin(), edge_values_.end(), 0.0);
}

BlockLdlt::Block BlockLdlt::node_block(int node) {
  return {node_values_.data() + node_start_[node], block_rows_[node], block_rows_[node]};
}

BlockLdlt::Block BlockLdlt::edge_block(int edge) {
  return {edge_values_.data() + edge_start_[edge], block_rows_[edges_[edge].first],
          block_rows_[edges_[edge].second]};
}

void BlockLdlt::assemble_front(const Front& front, std::vector<MatrixXd>& updates, MatrixXd& dense) const {
  const int size = front.pivot_rows + front.update_rows;
  dense.setZero(size, size);
  using ConstBlock = Eigen::Map<const MatrixXd>;
  for (std::size_t p = 0; p < front.pivots.size(); ++p) {
    const int position = front.pivots[p], node = order_.block_at[position];
    const int row = front.first_row[p], rows = block_rows_[node];
    dense.block(row, row, rows, rows) += ConstBlock(node_values_.data() + node_start_[node], rows, rows);
    for (int edge : edges_at_[position]) {
      const auto [a, b] = edges_[edge];
      const ConstBlock block(edge_values_.data() + edge_start_[edge], block_rows_[a], block_rows_[b]);
      add_lower(dense, front_row(front, order_.position[a]), front_row(front, order_.position[b]), block);
    }
  }
  for (int child : front.children) {
    const std::vector<int>& to = order_.fronts[child].parent_row;
    MatrixXd& update = updates[child];
    for (Eigen::Index c = 0; c < update.cols(); ++c)
      for (Eigen::Index r = c; r < update.rows(); ++r) dense(to[r], to[c]) += update(r, c);
    update.resize(0, 0);
  }
}

// D's blocks of order 2 are indefinite by the choice of pivots, unless rounding says otherwise.
void BlockLdlt::count_inertia(const Factor& factor) {
  const auto n = static_cast<int>(factor.pivot.rows());
  for (int c = 0; c < n;) {
    const double d = factor.pivot(c, c);
    if (factor.swaps[c] > 0) {
      ++(d > 0 ? inertia_.positive : d < 0 ? inertia_.negative : inertia_.zero);
      c += 1;
      continue;
    }
    const double off = factor.pivot(c + 1, c), next = factor.pivot(c + 1, c + 1);
    if (d * next - off * off < 0) {
      ++inertia_.positive;
      ++inertia_.negative;
    } else {
      (d + next > 0 ? inertia_.positive : inertia_.negative) += 2;
    }
    c += 2;
  }
}

bool BlockLdlt::factorise() {
  inertia_ = {};
  std::vector<MatrixXd> updates(order_.fronts.size());
  MatrixXd dense;
  std::vector<double> work;
  const double one = 1, minus_one = -1;
  for (std::size_t f = 0; f < order_.fronts.size(); ++f) {
    const Front& front = order_.fronts[f];
    Factor& factor = factors_[f];
    assemble_front(front, updates, dense);
    const int k = front.pivot_rows, u = front.update_rows, size = k + u;
    if (k == 0) {
      updates[f] = dense;
      continue;
    }
    factor.pivot = dense.topLeftCorner(k, k);
    factor.swaps.resize(k);
    const int work_size = std::max(64 * k, size);
    work.resize(work_size);
    int info = 0;
    dsytrf_("L", &k, factor.pivot.data(), &k, factor.swaps.data(), work.data(), &work_size, &info);
    if (info != 0 || !factor.pivot.allFinite()) return false;
    count_inertia(factor);
    if (u == 0) continue;

    factor.coupling = dense.bottomLeftCorner(u, k).transpose();
    if (k > kWidthForLevel3)
      dsytrs2_("L", &k, &u, factor.pivot.data(), &k, factor.swaps.data(), factor.coupling.data(), &k,
               work.data(), &info);
    else
      dsytrs_("L", &k, &u, factor.pivot.data(), &k, factor.swaps.data(), factor.coupling.data(), &k, &info);
    if (info != 0) return false;
    MatrixXd& update = updates[f];
    update = dense.bottomRightCorner(u, u);
    for (int column = 0; column < u; column += kUpdateColumns) {
      const int columns = std::min(kUpdateColumns, u - column), rows = u - column;
      dgemm_("N", "N", &rows, &columns, &k, &minus_one, &dense(k + column, 0), &size,
             &factor.coupling(0, column), &k, &one, &update(column, column), &u);
    }
  }
  return inertia_.zero == 0;
}

void BlockLdlt::solve_in_place(Eigen::Ref<MatrixXd> b) const {
  const int columns = static_cast<int>(b.cols());
  MatrixXd pivot_part, update_part;
  const auto for_updates = [&](const Front& front, auto&& act) {
    int row = 0;
    for (int position : front.updates) {
      const int block = order_.block_at[position], rows = block_rows_[block];
      act(b.middleRows(first_row_[block], rows), row, rows);
      row += rows;
    }
  };
  for (std::size_t f = 0; f < order_.fronts.size(); ++f) {
    const Front& front = order_.fronts[f];
    if (front.pivot_rows == 0) continue;
    const int first = first_row_[order_.block_at[front.pivots.front()]], k = front.pivot_rows;
    pivot_part = b.middleRows(first, k);
    if (front.update_rows > 0) {
      update_part.noalias() = factors_[f].coupling.transpose() * pivot_part;
      for_updates(front, [&](auto block, int row, int rows) { block -= update_part.middleRows(row, rows); });
    }
    int info = 0;
    dsytrs_("L", &k, &columns, factors_[f].pivot.data(), &k, factors_[f].swaps.data(), pivot_part.data(), &k,
            &info);
    b.middleRows(first, k) = pivot_part;
  }
  for (std::size_t f = order_.fronts.size(); f-- > 0;) {
    const Front& front = order_.fronts[f];
    if (front.pivot_rows == 0 || front.update_rows == 0) continue;
    update_part.resize(front.update_rows, columns);
    for_updates(front, [&](auto block, int row, int rows) { update_part.middleRows(row, rows) = block; });
    b.middleRows(first_row_[order_.block_at[front.pivots.front()]], front.pivot_rows).noalias() -=
        factors_[f].coupling * update_part;
  }
}

VectorXd BlockLdlt::multiply(const VectorXd& x) const {
  using ConstBlock = Eigen::Map<const MatrixXd>;
  VectorXd y = VectorXd::Zero(rows_);
  for (std::size_t i = 0; i < block_rows_.size(); ++i) {
    const int row = first_row_[i], rows = block_rows_[i];
    y.segment(row, rows) +=
        ConstBlock(node_values_.data() + node_start_[i], rows, rows) * x.segment(row, rows);
  }
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const auto [a, b] = edges_[e];
    const ConstBlock block(edge_values_.data() + edge_start_[e], block_rows_[a], block_rows_[b]);
    y.segment(first_row_[a], block_rows_[a]) += block * x.segment(first_row_[b], block_rows_[b]);
    y.segment(first_row_[b], block_rows_[b]) += block.transpose() * x.segment(first_row_[a], block_rows_[a]);
  }
  return y;
}

}  // namespace skinframe
