// SPDX-License-Identifier: GPL-3.0-or-later
// Which things hang together: union-find over 0 .. n-1.
#pragma once

#include <cstddef>
#include <numeric>
#include <vector>

namespace skinframe {

class DisjointSets {
 public:
  explicit DisjointSets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  int find(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(int i, int j) { parent_[find(i)] = find(j); }

 private:
  std::vector<int> parent_;
};

}  // namespace skinframe
