// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/dense_front.h"

#include <algorithm>
#include <cmath>
#include <utility>

extern "C" {
void dsytrf_(const char* uplo, const int* n, double* a, const int* lda, int* ipiv, double* work,
             const int* lwork, int* info);
void dtrsm_(const char* side, const char* uplo, const char* trans, const char* diag, const int* m,
            const int* n, const double* alpha, const double* a, const int* lda, double* b, const int* ldb);
void dtrsv_(const char* uplo, const char* trans, const char* diag, const int* n, const double* a,
            const int* lda, double* x, const int* incx);
void dgemm_(const char* transa, const char* transb, const int* m, const int* n, const int* k,
            const double* alpha, const double* a, const int* lda, const double* b, const int* ldb,
            const double* beta, double* c, const int* ldc);
void dgemv_(const char* trans, const int* m, const int* n, const double* alpha, const double* a,
            const int* lda, const double* x, const int* incx, const double* beta, double* y, const int* incy);
void dswap_(const int* n, double* x, const int* incx, double* y, const int* incy);
}

namespace skinframe {
namespace {

constexpr double kOne = 1, kMinusOne = -1, kZero = 0;
constexpr int kStride1 = 1;
constexpr int kWorkColumns = 64;  // dsytrf works in blocks of so many

int order_at(const FrontPivots& pivots, int i) { return pivots.swaps[i] > 0 ? 1 : 2; }

// The exchange that came with the pivot at i: its last row with the other.
std::pair<int, int> exchange_at(const FrontPivots& pivots, int i) {
  return {i + order_at(pivots, i) - 1, std::abs(pivots.swaps[i]) - 1};
}

template <class Act>
void for_pivots(const FrontPivots& pivots, FrontRange block, Act&& act) {
  for (int i = block.begin; i < block.end; i += order_at(pivots, i)) act(i);
}

template <class Act>
void for_blocks(int pivots, Act&& act) {
  for (int begin = 0; begin < pivots; begin += kPivotBlock)
    act(FrontRange{begin, std::min(pivots, begin + kPivotBlock)});
}

// D moves out of the panel, inverted; false when it cannot be.
bool take_diagonal(const FrontPanel& panel, FrontPivots& pivots, FrontRange block, Inertia& inertia) {
  bool regular = true;
  for_pivots(pivots, block, [&](int i) {
    const double d = *panel.at(i, i);
    if (order_at(pivots, i) == 1) {
      ++(d > 0 ? inertia.positive : d < 0 ? inertia.negative : inertia.zero);
      pivots.inverse_diagonal[i] = 1 / d;
      pivots.inverse_coupling[i] = 0;
      regular = regular && d != 0 && std::isfinite(d);
      return;
    }
    double& coupling = *panel.at(i + 1, i);
    const double next = *panel.at(i + 1, i + 1), determinant = d * next - coupling * coupling;
    // Indefinite by the choice of pivots, unless rounding says otherwise.
    if (determinant < 0) {
      ++inertia.positive;
      ++inertia.negative;
    } else {
      (d + next > 0 ? inertia.positive : inertia.negative) += 2;
    }
    pivots.inverse_diagonal[i] = next / determinant;
    pivots.inverse_diagonal[i + 1] = d / determinant;
    pivots.inverse_coupling[i] = -coupling / determinant;
    pivots.inverse_coupling[i + 1] = 0;
    coupling = 0;
    regular = regular && determinant != 0 && std::isfinite(determinant);
  });
  return regular;
}

// dsytrf leaves rows of earlier columns where they were before an exchange: bring them along, so that L is
// explicit.
void exchange_rows_of_factor(const FrontPanel& panel, const FrontPivots& pivots, FrontRange block) {
  const int stride = panel.rows();
  for_pivots(pivots, block, [&](int i) {
    const auto [from, to] = exchange_at(pivots, i);
    const int columns = i - block.begin;
    if (from != to && columns > 0)
      dswap_(&columns, panel.at(from, block.begin), &stride, panel.at(to, block.begin), &stride);
  });
}

// to(.., i) = the columns of `from` that D^-1 couples to i.
void times_inverse_diagonal(const FrontPivots& pivots, FrontRange block, const double* from, int from_stride,
                            double* to, int rows) {
  for_pivots(pivots, block, [&](int i) {
    const double* left = from + static_cast<std::size_t>(i - block.begin) * from_stride;
    double* to_left = to + static_cast<std::size_t>(i - block.begin) * rows;
    const double d = pivots.inverse_diagonal[i];
    if (order_at(pivots, i) == 1) {
      for (int r = 0; r < rows; ++r) to_left[r] = d * left[r];
      return;
    }
    const double* right = left + from_stride;
    double* to_right = to_left + rows;
    const double coupling = pivots.inverse_coupling[i], next = pivots.inverse_diagonal[i + 1];
    for (int r = 0; r < rows; ++r) {
      to_left[r] = d * left[r] + coupling * right[r];
      to_right[r] = coupling * left[r] + next * right[r];
    }
  });
}

// x <- D^-1 x for the rows of the block, x its first.
void times_inverse_diagonal(const FrontPivots& pivots, FrontRange block, double* x) {
  for_pivots(pivots, block, [&](int i) {
    double* here = x + (i - block.begin);
    const double first = here[0];
    here[0] = pivots.inverse_diagonal[i] * first;
    if (order_at(pivots, i) == 1) return;
    here[0] += pivots.inverse_coupling[i] * here[1];
    here[1] = pivots.inverse_coupling[i] * first + pivots.inverse_diagonal[i + 1] * here[1];
  });
}

void solve_triangle(const FrontPanel& panel, FrontRange block, const char* transposed, double* x, int stride,
                    int columns) {
  const int rows = panel.rows(), size = block.size();
  if (columns == 1)
    dtrsv_("L", transposed, "U", &size, panel.at(block.begin, block.begin), &rows, x, &kStride1);
  else
    dtrsm_("L", "L", transposed, "U", &size, &columns, &kOne, panel.at(block.begin, block.begin), &rows, x,
           &stride);
}

}  // namespace

bool factorise_block(const FrontPanel& panel, FrontPivots& pivots, FrontRange block, Inertia& inertia) {
  pivots.swaps.resize(panel.pivots);
  pivots.inverse_diagonal.resize(panel.pivots);
  pivots.inverse_coupling.resize(panel.pivots);
  const int size = block.size(), stride = panel.rows(), work_size = kWorkColumns * size;
  std::vector<double> work(work_size);
  int* swaps = pivots.swaps.data() + block.begin;
  int info = 0;
  dsytrf_("L", &size, panel.at(block.begin, block.begin), &stride, swaps, work.data(), &work_size, &info);
  for (int i = 0; i < size; ++i) swaps[i] += swaps[i] > 0 ? block.begin : -block.begin;
  if (info != 0 || !take_diagonal(panel, pivots, block, inertia)) return false;
  exchange_rows_of_factor(panel, pivots, block);
  return true;
}

void solve_rows(const FrontPanel& panel, const FrontPivots& pivots, FrontRange block, FrontRange rows) {
  const int size = block.size(), stride = panel.rows(), count = rows.size();
  for_pivots(pivots, block, [&](int i) {
    const auto [from, to] = exchange_at(pivots, i);
    if (from != to)
      dswap_(&count, panel.at(rows.begin, from), &kStride1, panel.at(rows.begin, to), &kStride1);
  });
  dtrsm_("R", "L", "T", "U", &count, &size, &kOne, panel.at(block.begin, block.begin), &stride,
         panel.at(rows.begin, block.begin), &stride);
}

void update_columns(const FrontPanel& panel, const FrontPivots& pivots, FrontRange block, FrontRange columns,
                    double* target, int stride) {
  const int size = block.size(), rows = panel.rows(), width = columns.size();
  const int below = rows - columns.begin;
  const double* w = panel.at(columns.begin, block.begin);
  std::vector<double> scaled(static_cast<std::size_t>(width) * size);
  times_inverse_diagonal(pivots, block, w, rows, scaled.data(), width);
  dgemm_("N", "T", &below, &width, &size, &kMinusOne, w, &rows, scaled.data(), &width, &kOne, target,
         &stride);
}

void solve_forward(const FrontPanel& panel, const FrontPivots& pivots, double* v, int columns) {
  const int rows = panel.rows();
  for_blocks(panel.pivots, [&](FrontRange block) {
    const int size = block.size(), below = rows - block.end;
    for_pivots(pivots, block, [&](int i) {
      const auto [from, to] = exchange_at(pivots, i);
      for (int c = 0; from != to && c < columns; ++c) std::swap(v[c * rows + from], v[c * rows + to]);
    });
    solve_triangle(panel, block, "N", v + block.begin, rows, columns);
    for (int c = 0; c < columns; ++c)
      times_inverse_diagonal(pivots, block, v + static_cast<std::size_t>(c) * rows + block.begin);
    if (below == 0) return;
    if (columns == 1)
      dgemv_("N", &below, &size, &kMinusOne, panel.at(block.end, block.begin), &rows, v + block.begin,
             &kStride1, &kOne, v + block.end, &kStride1);
    else
      dgemm_("N", "N", &below, &columns, &size, &kMinusOne, panel.at(block.end, block.begin), &rows,
             v + block.begin, &rows, &kOne, v + block.end, &rows);
  });
}

void solve_backward(const FrontPanel& panel, const FrontPivots& pivots, double* v, int columns) {
  const int rows = panel.rows();
  std::vector<FrontRange> blocks;
  for_blocks(panel.pivots, [&](FrontRange block) { blocks.push_back(block); });
  std::vector<double> known;
  for (auto at = blocks.rbegin(); at != blocks.rend(); ++at) {
    const FrontRange block = *at;
    const int size = block.size(), below = rows - block.end;
    known.assign(static_cast<std::size_t>(size) * columns, 0.0);
    if (below > 0 && columns == 1)
      dgemv_("T", &below, &size, &kOne, panel.at(block.end, block.begin), &rows, v + block.end, &kStride1,
             &kZero, known.data(), &kStride1);
    else if (below > 0)
      dgemm_("T", "N", &size, &columns, &below, &kOne, panel.at(block.end, block.begin), &rows, v + block.end,
             &rows, &kZero, known.data(), &size);
    for (int c = 0; c < columns; ++c) {
      double* from = known.data() + static_cast<std::size_t>(c) * size;
      double* x = v + static_cast<std::size_t>(c) * rows + block.begin;
      times_inverse_diagonal(pivots, block, from);
      for (int i = 0; i < size; ++i) x[i] -= from[i];
    }
    solve_triangle(panel, block, "T", v + block.begin, rows, columns);
    for (int i = block.end - 1; i >= block.begin; --i) {  // the exchanges, last one first
      if (order_at(pivots, i) == 2) --i;
      const auto [from, to] = exchange_at(pivots, i);
      for (int c = 0; from != to && c < columns; ++c) std::swap(v[c * rows + from], v[c * rows + to]);
    }
  }
}

}  // namespace skinframe
