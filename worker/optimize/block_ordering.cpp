// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/block_ordering.h"

#include <metis.h>

#include <algorithm>
#include <numeric>

#include "worker/run/ordering_turn.h"
#include "worker/run/result.h"

namespace skinframe {
namespace {

using Lists = std::vector<std::vector<int>>;

// A supernode takes its neighbour in when both are narrow, or when the zeros this stores stay a small share.
constexpr long kNarrowRows = 24;
constexpr double kZeroShareOfNarrow = 0.5;
constexpr double kZeroShare = 0.08;

Lists adjacency(int blocks, const std::vector<std::pair<int, int>>& edges) {
  Lists neighbours(blocks);
  for (const auto& [a, b] : edges) {
    neighbours[a].push_back(b);
    neighbours[b].push_back(a);
  }
  for (auto& list : neighbours) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return neighbours;
}

std::vector<int> nested_dissection(const Lists& neighbours) {
  const std::size_t blocks = neighbours.size();
  std::vector<int> block_at(blocks);
  std::iota(block_at.begin(), block_at.end(), 0);
  std::vector<idx_t> start(blocks + 1, 0), list, order(blocks), inverse(blocks);
  for (std::size_t i = 0; i < blocks; ++i) {
    list.insert(list.end(), neighbours[i].begin(), neighbours[i].end());
    start[i + 1] = static_cast<idx_t>(list.size());
  }
  if (list.empty()) return block_at;  // METIS does not take graphs without edges
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1;
  idx_t count = static_cast<idx_t>(blocks);
  const OrderingTurn turn;
  const int status =
      METIS_NodeND(&count, start.data(), list.data(), nullptr, options, order.data(), inverse.data());
  if (status == METIS_OK) block_at.assign(order.begin(), order.end());
  return block_at;  // any order is correct; this one is merely slow
}

struct EliminationTree {
  std::vector<int> parent;  // position, -1 for a root
  Lists children;
  Lists structure;  // later positions each position touches, ascending
};

EliminationTree eliminate(const Lists& neighbours, const BlockOrdering& order) {
  const int n = static_cast<int>(neighbours.size());
  EliminationTree tree{std::vector<int>(n, -1), Lists(n), Lists(n)};
  std::vector<int> seen_by(n, -1);
  for (int k = 0; k < n; ++k) {
    auto& structure = tree.structure[k];
    const auto touch = [&](int q) {
      if (q > k && seen_by[q] != k) {
        seen_by[q] = k;
        structure.push_back(q);
      }
    };
    for (int j : neighbours[order.block_at[k]]) touch(order.position[j]);
    for (int child : tree.children[k])
      for (int q : tree.structure[child]) touch(q);
    std::sort(structure.begin(), structure.end());
    if (structure.empty()) continue;
    tree.parent[k] = structure.front();
    tree.children[structure.front()].push_back(k);
  }
  return tree;
}

std::vector<int> postorder(const EliminationTree& tree) {
  const int n = static_cast<int>(tree.parent.size());
  std::vector<int> order;
  order.reserve(n);
  std::vector<std::pair<int, std::size_t>> path;  // node, next child
  for (int root = 0; root < n; ++root) {
    if (tree.parent[root] >= 0) continue;
    path.emplace_back(root, 0);
    while (!path.empty()) {
      auto& [node, next] = path.back();
      if (next < tree.children[node].size()) {
        path.emplace_back(tree.children[node][next++], 0);
      } else {
        order.push_back(node);
        path.pop_back();
      }
    }
  }
  return order;
}

void set_order(BlockOrdering& order, std::vector<int> block_at) {
  order.block_at = std::move(block_at);
  order.position.resize(order.block_at.size());
  for (std::size_t k = 0; k < order.block_at.size(); ++k)
    order.position[order.block_at[k]] = static_cast<int>(k);
}

// Positions [begin, end) eliminated together.
struct Supernode {
  int begin = 0, end = 0;
  long rows = 0, update_rows = 0, zeros = 0;
  const std::vector<int>* updates = nullptr;
};

std::vector<Supernode> fundamental_supernodes(const EliminationTree& tree, const std::vector<long>& rows_at) {
  std::vector<Supernode> nodes;
  for (int k = 0; k < static_cast<int>(tree.parent.size()); ++k) {
    const bool extends =
        k > 0 && tree.parent[k - 1] == k && tree.structure[k - 1].size() == tree.structure[k].size() + 1;
    if (!extends) nodes.push_back({k, k, 0, 0, 0, nullptr});
    nodes.back().end = k + 1;
    nodes.back().rows += rows_at[k];
    nodes.back().updates = &tree.structure[k];
  }
  for (Supernode& node : nodes)
    for (int q : *node.updates) node.update_rows += rows_at[q];
  return nodes;
}

bool worth_merging(const Supernode& child, const Supernode& parent, long& zeros) {
  if (child.end != parent.begin || child.updates->empty() || child.updates->front() != parent.begin)
    return false;
  zeros = child.rows * (parent.rows + parent.update_rows - child.update_rows) + child.zeros + parent.zeros;
  const double stored = static_cast<double>(child.rows + parent.rows) *
                        static_cast<double>(child.rows + parent.rows + parent.update_rows);
  const auto share = static_cast<double>(zeros);
  return (child.rows < kNarrowRows && parent.rows < 4 * kNarrowRows && share < kZeroShareOfNarrow * stored) ||
         share < kZeroShare * stored || child.rows + parent.rows < kNarrowRows;
}

std::vector<Supernode> merge_supernodes(std::vector<Supernode> nodes) {
  for (bool merged = true; merged;) {
    merged = false;
    std::vector<Supernode> kept;
    for (Supernode node : nodes) {
      long zeros = 0;
      if (!kept.empty() && worth_merging(kept.back(), node, zeros)) {
        node.begin = kept.back().begin;
        node.rows += kept.back().rows;
        node.zeros = zeros;
        kept.pop_back();
        merged = true;
      }
      kept.push_back(node);
    }
    nodes = std::move(kept);
  }
  return nodes;
}

std::vector<Front> make_fronts(const std::vector<Supernode>& nodes, const std::vector<long>& rows_at) {
  std::vector<int> front_of(rows_at.size());
  for (std::size_t f = 0; f < nodes.size(); ++f)
    for (int k = nodes[f].begin; k < nodes[f].end; ++k) front_of[k] = static_cast<int>(f);

  std::vector<Front> fronts(nodes.size());
  for (std::size_t f = 0; f < nodes.size(); ++f) {
    Front& front = fronts[f];
    for (int k = nodes[f].begin; k < nodes[f].end; ++k) {
      front.pivots.push_back(k);
      front.first_row.push_back(front.pivot_rows);
      front.pivot_rows += static_cast<int>(rows_at[k]);
    }
    front.updates = *nodes[f].updates;
    for (int q : front.updates) {
      front.first_row.push_back(front.pivot_rows + front.update_rows);
      front.update_rows += static_cast<int>(rows_at[q]);
    }
    if (!front.updates.empty()) front.parent = front_of[front.updates.front()];
  }
  for (std::size_t f = 0; f < fronts.size(); ++f) {
    Front& front = fronts[f];
    if (front.parent < 0) continue;
    fronts[front.parent].children.push_back(static_cast<int>(f));
    int from = 0;
    for (int q : front.updates) {
      const int to = front_row(fronts[front.parent], q), rows = static_cast<int>(rows_at[q]);
      if (!front.to_parent.empty() && front.to_parent.back().to + front.to_parent.back().rows == to)
        front.to_parent.back().rows += rows;
      else if (rows > 0)
        front.to_parent.push_back({from, to, rows});
      from += rows;
    }
  }
  return fronts;
}

}  // namespace

int front_row(const Front& front, int position) {
  if (position <= front.pivots.back()) return front.first_row[position - front.pivots.front()];
  const auto at = std::lower_bound(front.updates.begin(), front.updates.end(), position);
  SKINFRAME_CHECK(at != front.updates.end() && *at == position);
  return front.first_row[front.pivots.size() + static_cast<std::size_t>(at - front.updates.begin())];
}

BlockOrdering order_blocks(const std::vector<int>& block_rows,
                           const std::vector<std::pair<int, int>>& edges) {
  const int blocks = static_cast<int>(block_rows.size());
  const Lists neighbours = adjacency(blocks, edges);
  BlockOrdering order;
  set_order(order, nested_dissection(neighbours));

  std::vector<int> block_at;
  for (int k : postorder(eliminate(neighbours, order))) block_at.push_back(order.block_at[k]);
  set_order(order, std::move(block_at));

  std::vector<long> rows_at(blocks);
  for (int k = 0; k < blocks; ++k) rows_at[k] = block_rows[order.block_at[k]];
  const EliminationTree tree = eliminate(neighbours, order);
  order.fronts = make_fronts(merge_supernodes(fundamental_supernodes(tree, rows_at)), rows_at);
  return order;
}

}  // namespace skinframe
