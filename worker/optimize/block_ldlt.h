// SPDX-License-Identifier: GPL-3.0-or-later
// Multifrontal L D L^T of a symmetric indefinite matrix made of dense blocks on a graph: one block a node,
// one an edge. Within a front all pivots stand in one dense block (dense_front.h), so that the displacements
// and multipliers of a node, coupled as [0 K; K 0], pivot with one another. No pivot is delayed to a later
// front: the caller refines iteratively and regularises where the inertia is wrong.
//
// Guarantee: the same bits at any number of threads, when BLAS runs on one: use_one_blas_thread()
// (worker/run).
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "worker/optimize/block_ordering.h"
#include "worker/optimize/dense_front.h"
#include "worker/optimize/front_schedule.h"
#include "worker/optimize/thread_team.h"

namespace skinframe {

class BlockLdlt {
 public:
  using Block = Eigen::Map<Eigen::MatrixXd>;

  // `team` is shared and may be null: one thread. `cancelled` is asked before each front.
  BlockLdlt(std::vector<int> block_rows, std::vector<std::pair<int, int>> edges,
            std::shared_ptr<ThreadTeam> team = nullptr, std::function<bool()> cancelled = {});

  int rows() const { return rows_; }
  int first_row(int node) const { return first_row_[node]; }  // of the node in vectors

  // The values: all of the symmetric diagonal block, and for edge (a, b) the block with a's rows and b's
  // columns.
  void set_zero();
  Block node_block(int node);
  Block edge_block(int edge);

  // False when a pivot block is singular or the caller has cancelled. The inertia is valid after true.
  bool factorise();
  const Inertia& inertia() const { return inertia_; }

  void solve_in_place(Eigen::Ref<Eigen::MatrixXd> right_hand_sides) const;
  Eigen::VectorXd multiply(const Eigen::VectorXd& x) const;  // by the matrix as set, not by its factors

 private:
  FrontPanel panel(int front) const;
  double* update_of(int front);
  void add_child(int child, FrontRange wanted);
  void assemble_columns(int front, FrontRange columns);
  void add_entries(int front);
  bool factorise_front(int front, Inertia& inertia, bool share);
  bool run(const std::vector<int>& fronts, Inertia& inertia, bool share);

  std::vector<int> block_rows_;
  std::vector<std::pair<int, int>> edges_;
  BlockOrdering order_;
  FrontSchedule schedule_;
  std::shared_ptr<ThreadTeam> team_;
  std::function<bool()> cancelled_;
  int rows_ = 0;
  std::vector<int> first_row_;
  std::vector<std::size_t> node_start_, edge_start_;
  std::vector<double> node_values_, edge_values_;
  std::vector<std::vector<int>> edges_at_;     // by the position of the end eliminated first
  std::vector<std::vector<int>> update_rows_;  // of each front, in vectors
  std::vector<std::size_t> panel_start_;
  mutable std::vector<double> panels_;
  std::vector<FrontPivots> pivots_;
  std::vector<std::vector<double>> updates_;  // the schedule's arenas
  Inertia inertia_;
};

}  // namespace skinframe
