// SPDX-License-Identifier: GPL-3.0-or-later
// The lower half of a stiffness matrix with `width` freedoms a node, put together element by element. What
// couples with what is known before the first value, so each value finds its place: no list of triplets,
// which would take several times the memory and a sort.
#pragma once

#include <Eigen/SparseCore>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace skinframe {

class NodeMatrix {
 public:
  using Matrix = Eigen::SparseMatrix<double>;

  // is_free: width a node, node after node; what is held has no row. links: pairs of nodes that an element
  // joins, in any order and as often as they come; each node is coupled with itself.
  NodeMatrix(int width, const std::vector<char>& is_free, std::vector<std::pair<int, int>> links);

  // The element's stiffness on all freedoms of its nodes, node after node, both halves. Every two of its
  // nodes are linked.
  void add(std::span<const int> nodes, const Eigen::Ref<const Eigen::MatrixXd>& stiffness);

  int row(std::size_t freedom) const { return rows_[freedom]; }  // -1: held
  int rows() const { return first_row_.back(); }
  const Matrix& lower() const { return lower_; }

  // The graph of the nodes, its lower half: node v's rows are first_row(v) up to first_row(v + 1); it is
  // linked to those of linked_from(v), itself first, ascending.
  int node_count() const { return static_cast<int>(first_row_.size()) - 1; }
  int first_row(int node) const { return first_row_[node]; }
  std::span<const int> linked_from(int node) const {
    return {linked_.data() + first_link_[node], linked_.data() + first_link_[node + 1]};
  }

 private:
  int free_of(int node) const { return first_row_[node + 1] - first_row_[node]; }
  int link_of(int node, int later) const;
  void link(std::vector<std::pair<int, int>> links);
  void make_pattern();

  int width_;
  std::vector<int> rows_, first_row_;
  std::vector<int> first_link_, linked_;
  std::vector<int> above_;  // of each link: entries of a whole column of the node's block above it
  Matrix lower_;
};

}  // namespace skinframe
