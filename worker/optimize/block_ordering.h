// SPDX-License-Identifier: GPL-3.0-or-later
// The order of elimination of a symmetric block matrix on a graph, and the fronts of its multifrontal
// factorisation. Nested dissection (METIS, fixed seed) on the graph of blocks, elimination tree in postorder,
// fundamental supernodes merged where that adds few zeros (Duff and Reid 1983; Liu 1992), wide ones cut into
// a chain of fronts so that several threads can share the update of each.
//
// "Position" is a block's place in the order of elimination; "row" counts scalars.
#pragma once

#include <utility>
#include <vector>

namespace skinframe {

struct Front {
  std::vector<int> pivots;    // positions eliminated here: consecutive, ascending
  std::vector<int> updates;   // later positions this front touches, ascending
  std::vector<int> children;  // fronts whose update matrix adds into this one
  int parent = -1;
  int pivot_rows = 0;
  int update_rows = 0;
  std::vector<int> first_row;  // in the front, of each pivot and then each update
  // Where the update rows go in the parent's front, both ascending.
  struct Run {
    int from, to, rows;
  };
  std::vector<Run> to_parent;

  double work() const {  // multiplications, about
    const double k = pivot_rows, u = update_rows;
    return k * k * k / 3 + k * k * u + k * u * u;
  }
};

struct BlockOrdering {
  std::vector<int> block_at;  // block at each position
  std::vector<int> position;  // position of each block
  std::vector<Front> fronts;  // children before parents
};

// Edges join different blocks; an edge may stand more than once.
BlockOrdering order_blocks(const std::vector<int>& block_rows, const std::vector<std::pair<int, int>>& edges);

// The first row of `position` in the front; it is one of its pivots or updates.
int front_row(const Front& front, int position);

}  // namespace skinframe
