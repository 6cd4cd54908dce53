// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/block_ldlt.h"

#include <algorithm>
#include <atomic>

namespace skinframe {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using ConstBlock = Eigen::Map<const MatrixXd>;

// How the work on one front is cut for the team. The cuts are made at any number of threads, since the order
// of sums within BLAS depends on them.
constexpr int kSolvedRows = 192;
constexpr int kUpdatedColumns = 96;
constexpr int kAssembledColumns = 96;

}  // namespace

BlockLdlt::BlockLdlt(std::vector<int> block_rows, std::vector<std::pair<int, int>> edges,
                     std::shared_ptr<ThreadTeam> team, std::function<bool()> cancelled)
    : block_rows_(std::move(block_rows)),
      edges_(std::move(edges)),
      order_(order_blocks(block_rows_, edges_)),
      schedule_(schedule_fronts(order_.fronts)),
      team_(std::move(team)),
      cancelled_(std::move(cancelled)) {
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
  values = 0;
  for (const Front& front : order_.fronts) {
    panel_start_.push_back(values);
    values += static_cast<std::size_t>(front.pivot_rows) * (front.pivot_rows + front.update_rows);
    std::vector<int>& rows = update_rows_.emplace_back();
    for (int position : front.updates)
      for (int row = 0; row < block_rows_[order_.block_at[position]]; ++row)
        rows.push_back(first_row_[order_.block_at[position]] + row);
  }
  panels_.resize(values);
  pivots_.resize(order_.fronts.size());
  for (std::size_t size : schedule_.arena_size) updates_.emplace_back(size);
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

FrontPanel BlockLdlt::panel(int f) const {
  return {panels_.data() + panel_start_[f], order_.fronts[f].pivot_rows, order_.fronts[f].update_rows};
}

double* BlockLdlt::update_of(int f) {
  return updates_[schedule_.lane_of[f]].data() + schedule_.update_start[f];
}

// Adds what falls into these columns of the parent's front.
void BlockLdlt::add_child(int child, FrontRange wanted) {
  const Front& from = order_.fronts[child];
  const FrontPanel to = panel(from.parent);
  const double* update = update_of(child);
  double* parent_update = update_of(from.parent);
  for (std::size_t q = 0; q < from.to_parent.size(); ++q) {
    const Front::Run& columns = from.to_parent[q];
    const int last = std::min(columns.to + columns.rows, wanted.end);
    for (int column = std::max(columns.to, wanted.begin); column < last; ++column) {
      const int shift = column - columns.to;
      const double* source = update + static_cast<std::size_t>(columns.from + shift) * from.update_rows;
      double* target =
          column < to.pivots
              ? to.at(0, column)
              : parent_update + static_cast<std::size_t>(column - to.pivots) * to.updates - to.pivots;
      for (std::size_t r = q; r < from.to_parent.size(); ++r) {
        const Front::Run& rows = from.to_parent[r];
        const int skip = r == q ? shift : 0, count = rows.rows - skip;
        VectorXd::Map(target + rows.to + skip, count) += VectorXd::Map(source + rows.from + skip, count);
      }
    }
  }
}

void BlockLdlt::assemble_columns(int f, FrontRange columns) {
  const FrontPanel p = panel(f);
  double* update = update_of(f);
  for (int c = columns.begin; c < columns.end; ++c) {
    if (c < p.pivots)
      std::fill_n(p.at(c, c), p.rows() - c, 0.0);
    else
      std::fill_n(update + static_cast<std::size_t>(c - p.pivots) * (p.updates + 1), p.rows() - c, 0.0);
  }
  for (int child : order_.fronts[f].children) add_child(child, columns);
}

// The matrix' own entries, all of which stand in pivot columns.
void BlockLdlt::add_entries(int f) {
  const Front& front = order_.fronts[f];
  const FrontPanel p = panel(f);
  Eigen::Map<MatrixXd> dense(p.values, p.rows(), p.pivots);
  for (std::size_t i = 0; i < front.pivots.size(); ++i) {
    const int position = front.pivots[i], node = order_.block_at[position];
    const int row = front.first_row[i], rows = block_rows_[node];
    dense.block(row, row, rows, rows) += ConstBlock(node_values_.data() + node_start_[node], rows, rows);
    for (int edge : edges_at_[position]) {
      const auto [a, b] = edges_[edge];
      const ConstBlock block(edge_values_.data() + edge_start_[edge], block_rows_[a], block_rows_[b]);
      const int at_a = front_row(front, order_.position[a]), at_b = front_row(front, order_.position[b]);
      if (at_a >= at_b)
        dense.block(at_a, at_b, block.rows(), block.cols()) += block;
      else
        dense.block(at_b, at_a, block.cols(), block.rows()) += block.transpose();
    }
  }
}

// `share`: the team works on this one front together.
bool BlockLdlt::factorise_front(int f, Inertia& inertia, bool share) {
  const FrontPanel p = panel(f);
  FrontPivots& pivots = pivots_[f];
  const auto in_pieces = [&](FrontRange whole, int piece, auto&& act) {
    const int pieces = (whole.size() + piece - 1) / piece;
    const auto one = [&](int i) {
      const int begin = whole.begin + i * piece;
      act(FrontRange{begin, std::min(whole.end, begin + piece)});
    };
    if (share && team_)
      team_->run(pieces, one);
    else
      for (int i = 0; i < pieces; ++i) one(i);
  };
  in_pieces({0, p.rows()}, kAssembledColumns, [&](FrontRange columns) { assemble_columns(f, columns); });
  if (p.pivots == 0) return true;
  add_entries(f);
  for (int begin = 0; begin < p.pivots; begin += kPivotBlock) {
    const FrontRange block{begin, std::min(p.pivots, begin + kPivotBlock)};
    if (!factorise_block(p, pivots, block, inertia)) return false;
    in_pieces({block.end, p.rows()}, kSolvedRows,
              [&](FrontRange rows) { solve_rows(p, pivots, block, rows); });
    in_pieces({block.end, p.pivots}, kUpdatedColumns, [&](FrontRange columns) {
      update_columns(p, pivots, block, columns, p.at(columns.begin, columns.begin), p.rows());
    });
  }
  in_pieces({p.pivots, p.rows()}, kUpdatedColumns, [&](FrontRange columns) {
    double* target = update_of(f) + static_cast<std::size_t>(columns.begin - p.pivots) * (p.updates + 1);
    update_columns(p, pivots, {0, p.pivots}, columns, target, p.updates);
  });
  return true;
}

bool BlockLdlt::run(const std::vector<int>& fronts, Inertia& inertia, bool share) {
  return std::all_of(fronts.begin(), fronts.end(), [&](int f) {
    return !(cancelled_ && cancelled_()) && factorise_front(f, inertia, share);
  });
}

bool BlockLdlt::factorise() {
  std::vector<Inertia> found(kLanes + 1);
  std::atomic<bool> regular = true;
  const auto lane = [&](int l) {
    if (!run(schedule_.lanes[l], found[l], false)) regular = false;
  };
  if (team_)
    team_->run(kLanes, lane);
  else
    for (int l = 0; l < kLanes; ++l) lane(l);
  if (!regular || !run(schedule_.top, found[kLanes], true)) return false;
  inertia_ = {};
  for (const Inertia& part : found) {
    inertia_.positive += part.positive;
    inertia_.negative += part.negative;
    inertia_.zero += part.zero;
  }
  return inertia_.zero == 0;
}

void BlockLdlt::solve_in_place(Eigen::Ref<MatrixXd> b) const {
  const int columns = static_cast<int>(b.cols());
  std::vector<double> values;
  const auto with_front = [&](int f, auto&& solve) {
    const Front& front = order_.fronts[f];
    if (front.pivot_rows == 0) return;
    const int first = first_row_[order_.block_at[front.pivots.front()]], k = front.pivot_rows;
    values.resize(static_cast<std::size_t>(k + front.update_rows) * columns);
    Eigen::Map<MatrixXd> local(values.data(), k + front.update_rows, columns);
    for (int c = 0; c < columns; ++c) {
      local.col(c).head(k) = b.col(c).segment(first, k);
      for (int i = 0; i < front.update_rows; ++i) local(k + i, c) = b(update_rows_[f][i], c);
    }
    solve(panel(f), pivots_[f], values.data(), columns);
    for (int c = 0; c < columns; ++c) {
      b.col(c).segment(first, k) = local.col(c).head(k);
      for (int i = 0; i < front.update_rows; ++i) b(update_rows_[f][i], c) = local(k + i, c);
    }
  };
  const int fronts = static_cast<int>(order_.fronts.size());
  for (int f = 0; f < fronts; ++f) with_front(f, solve_forward);
  for (int f = fronts; f-- > 0;) with_front(f, solve_backward);
}

VectorXd BlockLdlt::multiply(const VectorXd& x) const {
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
