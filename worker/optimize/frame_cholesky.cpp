// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/frame_cholesky.h"

#include <Eigen/CholmodSupport>
#include <Eigen/SparseCore>
#include <algorithm>
#include <new>

#include "worker/run/ordering_turn.h"

namespace skinframe {
namespace {

using Eigen::VectorXd;
using SparseMatrix = Eigen::SparseMatrix<double>;

constexpr double kShift = 1e-14;  // of the largest diagonal entry: a node that nothing holds must not stop it

}  // namespace

struct FrameCholesky::Impl {
  int node_axes;              // 3 * cases
  std::vector<int> unknown;   // of each full entry; -1 where fixed
  std::vector<int> full;      // of each unknown
  SparseMatrix matrix;        // lower triangle
  std::vector<int> slots;     // into matrix.valuePtr(), a column-major block a strut; -1: not stored
  std::vector<int> diagonal;  // slot of each unknown
  Eigen::CholmodSupernodalLLT<SparseMatrix, Eigen::Lower> factor;

  Impl(const std::vector<std::pair<int, int>>& struts, const std::vector<std::array<bool, 3>>& fixed,
       int cases)
      : node_axes(3 * cases) {
    for (std::size_t i = 0; i < fixed.size(); ++i)
      for (int axis = 0; axis < node_axes; ++axis) {
        const bool free = !fixed[i][axis % 3];
        unknown.push_back(free ? static_cast<int>(full.size()) : -1);
        if (free) full.push_back(static_cast<int>(unknown.size()) - 1);
      }
    build_pattern(struts);
    factor.cholmod().print = 0;
    if (full.empty()) return;
    const OrderingTurn turn;
    factor.analyzePattern(matrix);
  }

  int unknown_of(const std::pair<int, int>& strut, int local) const {
    return local < node_axes ? unknown[node_axes * strut.first + local]
                             : unknown[node_axes * strut.second + local - node_axes];
  }

  void build_pattern(const std::vector<std::pair<int, int>>& struts) {
    const int width = 2 * node_axes, unknowns = static_cast<int>(full.size());
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(struts.size() * width * (width + 1) / 2 + unknowns);
    for (int u = 0; u < unknowns; ++u) entries.emplace_back(u, u, 0.0);
    const auto each = [&](auto&& visit) {
      for (const auto& strut : struts)
        for (int c = 0; c < width; ++c)
          for (int r = 0; r < width; ++r) visit(unknown_of(strut, r), unknown_of(strut, c));
    };
    each([&](int row, int column) {
      if (column >= 0 && row >= column) entries.emplace_back(row, column, 0.0);
    });
    matrix.resize(unknowns, unknowns);
    matrix.setFromTriplets(entries.begin(), entries.end());
    matrix.makeCompressed();
    slots.reserve(struts.size() * width * width);
    each(
        [&](int row, int column) { slots.push_back(column >= 0 && row >= column ? slot(row, column) : -1); });
    for (int u = 0; u < unknowns; ++u) diagonal.push_back(slot(u, u));
  }

  int slot(int row, int column) const {
    const int* begin = matrix.innerIndexPtr() + matrix.outerIndexPtr()[column];
    const int* end = matrix.innerIndexPtr() + matrix.outerIndexPtr()[column + 1];
    return static_cast<int>(std::lower_bound(begin, end, row) - matrix.innerIndexPtr());
  }
};

FrameCholesky::FrameCholesky(const std::vector<std::pair<int, int>>& struts,
                             const std::vector<std::array<bool, 3>>& fixed, int cases)
    : impl_(std::make_unique<Impl>(struts, fixed, cases)) {}
FrameCholesky::~FrameCholesky() = default;
FrameCholesky::FrameCholesky(FrameCholesky&&) noexcept = default;

int FrameCholesky::size() const { return static_cast<int>(impl_->unknown.size()); }

void FrameCholesky::clear() { std::fill_n(impl_->matrix.valuePtr(), impl_->matrix.nonZeros(), 0.0); }

void FrameCholesky::add(int strut, const Eigen::MatrixXd& block) {
  const int* slot = impl_->slots.data() + static_cast<std::size_t>(strut) * block.size();
  double* values = impl_->matrix.valuePtr();
  for (Eigen::Index k = 0; k < block.size(); ++k)
    if (slot[k] >= 0) values[slot[k]] += block.data()[k];
}

bool FrameCholesky::factorise() {
  if (impl_->full.empty()) return true;
  double largest = 0;
  for (int at : impl_->diagonal) largest = std::max(largest, impl_->matrix.valuePtr()[at]);
  if (!(largest > 0)) return false;
  for (int at : impl_->diagonal) impl_->matrix.valuePtr()[at] += kShift * largest;
  impl_->factor.factorize(impl_->matrix);
  if (impl_->factor.cholmod().status < CHOLMOD_OK) throw std::bad_alloc();  // which Eigen does not see
  return impl_->factor.info() == Eigen::Success;
}

VectorXd FrameCholesky::solve(const VectorXd& right_side) const {
  VectorXd packed(impl_->full.size()), out = VectorXd::Zero(right_side.size());
  if (packed.size() == 0) return out;
  for (Eigen::Index u = 0; u < packed.size(); ++u) packed[u] = right_side[impl_->full[u]];
  VectorXd solved = impl_->factor.solve(packed);
  // One refinement: near the end the matrix is stiff.
  const VectorXd left = packed - impl_->matrix.selfadjointView<Eigen::Lower>() * solved;
  solved += VectorXd(impl_->factor.solve(left));
  for (Eigen::Index u = 0; u < packed.size(); ++u) out[impl_->full[u]] = solved[u];
  return out;
}

}  // namespace skinframe
