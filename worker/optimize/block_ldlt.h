// SPDX-License-Identifier: GPL-3.0-or-later
// Multifrontal L D L^T of a symmetric indefinite matrix made of dense blocks on a graph: one block a node,
// one an edge. Within a front all pivots stand in one dense block, factorised by LAPACK's dsytrf (Bunch and
// Kaufman 1977), so that the displacements and multipliers of a node, coupled as [0 K; K 0], pivot with one
// another. No pivot is delayed to a later front: the caller refines iteratively and regularises where the
// inertia is wrong.
//
// Deterministic when BLAS runs on one thread: use_one_blas_thread().
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "worker/optimize/block_ordering.h"

namespace skinframe {

struct Inertia {
  int positive = 0, negative = 0, zero = 0;
  bool operator==(const Inertia&) const = default;
};

void use_one_blas_thread();  // of the whole process; nothing where BLAS is not OpenBLAS

class BlockLdlt {
 public:
  using Block = Eigen::Map<Eigen::MatrixXd>;

  BlockLdlt(std::vector<int> block_rows, std::vector<std::pair<int, int>> edges);

  int rows() const { return rows_; }
  int first_row(int node) const { return first_row_[node]; }  // of the node in vectors

  // The values: all of the symmetric diagonal block, and for edge (a, b) the block with a's rows and b's
  // columns.
  void set_zero();
  Block node_block(int node);
  Block edge_block(int edge);

  // False when a pivot block is singular. The inertia is valid after true.
  bool factorise();
  const Inertia& inertia() const { return inertia_; }

  void solve_in_place(Eigen::Ref<Eigen::MatrixXd> right_hand_sides) const;
  Eigen::VectorXd multiply(const Eigen::VectorXd& x) const;  // by the matrix as set, not by its factors

 private:
  struct Factor {
    Eigen::MatrixXd pivot;     // dsytrf's L and D
    std::vector<int> swaps;    // dsytrf's ipiv
    Eigen::MatrixXd coupling;  // pivot block^-1 times the coupling to the update rows
  };
  void assemble_front(const Front& front, std::vector<Eigen::MatrixXd>& updates,
                      Eigen::MatrixXd& dense) const;
  void count_inertia(const Factor& factor);

  std::vector<int> block_rows_;
  std::vector<std::pair<int, int>> edges_;
  BlockOrdering order_;
  int rows_ = 0;
  std::vector<int> first_row_;
  std::vector<std::size_t> node_start_, edge_start_;
  std::vector<double> node_values_, edge_values_;
  std::vector<std::vector<int>> edges_at_;  // by the position of the end eliminated first
  std::vector<Factor> factors_;             // one a front
  Inertia inertia_;
};

}  // namespace skinframe
