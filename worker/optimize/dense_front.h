// SPDX-License-Identifier: GPL-3.0-or-later
// The dense work of one front of the multifrontal factorisation: k pivot rows, u rows that they update.
//
//   [ P A11 P^T          ]   [ L        ] [ D     ] [ L^T  D^-1 W^T ]
//   [ A21 P^T      A22   ] = [ W D^-1  I ] [    S  ] [          I   ],   W = A21 P^T L^-T,   S = A22 - W D^-1
//   W^T
//
// The pivot rows are taken in blocks of kPivotBlock, each of which is factorised so, with what is below it as
// its W: pivots of order 1 and 2 after Bunch and Kaufman (LAPACK's dsytrf), sought within the block. W is
// kept and not W D^-1: the solves need one of the two, and the triangular solve that makes W works in place.
// Sums run in an order that depends on sizes and on begin and end alone.
#pragma once

#include <cstddef>
#include <vector>

namespace skinframe {

inline constexpr int kPivotBlock = 96;

// Where a front stands: k columns of k + u rows, column-major; L (unit diagonal, not stored), beneath it W.
struct FrontPanel {
  double* values = nullptr;
  int pivots = 0;   // k
  int updates = 0;  // u
  int rows() const { return pivots + updates; }
  double* at(int row, int column) const { return values + static_cast<std::size_t>(column) * rows() + row; }
};

struct FrontPivots {
  std::vector<int> swaps;  // row i was exchanged with |swaps[i]| - 1; negative: half of a pivot of order 2
  std::vector<double> inverse_diagonal, inverse_coupling;  // D^-1; coupling of i with i + 1, zero for order 1
};

struct Inertia {
  int positive = 0, negative = 0, zero = 0;
  bool operator==(const Inertia&) const = default;
};

// Half-open ranges of rows or columns of a front.
struct FrontRange {
  int begin = 0, end = 0;
  int size() const { return end - begin; }
};

// L and D of a block of pivots, in place; false: one vanishes or is not finite. Signs add to `inertia`.
bool factorise_block(const FrontPanel& panel, FrontPivots& pivots, FrontRange block, Inertia& inertia);

// These rows below the block become those of its W.
void solve_rows(const FrontPanel& panel, const FrontPivots& pivots, FrontRange block, FrontRange rows);

// target -= W D^-1 W^T of these pivots: the columns given, lower triangle. `target` is where (columns.begin,
// columns.begin) of the front stands, in columns of `stride`.
void update_columns(const FrontPanel& panel, const FrontPivots& pivots, FrontRange block, FrontRange columns,
                    double* target, int stride);

// With v of k + u rows and as many columns as said, x above and y below:
// x <- D^-1 L^-1 P x and y <- y - W x
void solve_forward(const FrontPanel& panel, const FrontPivots& pivots, double* v, int columns);
// x <- P^T L^-T (x - D^-1 W^T y)
void solve_backward(const FrontPanel& panel, const FrontPivots& pivots, double* v, int columns);

}  // namespace skinframe
