// SPDX-License-Identifier: GPL-3.0-or-later
// The edges of a mesh by the half-edges that lie on them. Half-edge 3 t + k runs from corner k of triangle t
// to the next corner. Internal to the room.
#pragma once

#include <array>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "worker/mesh/triangle_mesh.h"

namespace skinframe {

inline int triangle_of(int half_edge) { return half_edge / 3; }
inline int origin_of(const TriangleMesh& mesh, int half_edge) {
  return mesh.triangles[half_edge / 3][half_edge % 3];
}
inline int target_of(const TriangleMesh& mesh, int half_edge) {
  return mesh.triangles[half_edge / 3][(half_edge % 3 + 1) % 3];
}
inline int apex_of(const TriangleMesh& mesh, int half_edge) {
  return mesh.triangles[half_edge / 3][(half_edge % 3 + 2) % 3];
}

// Half-edges sorted by the unordered pair of their ends, then by number: the same mesh, the same order.
class EdgeTable {
 public:
  explicit EdgeTable(const TriangleMesh& mesh);

  std::size_t size() const { return starts_.size() - 1; }
  std::span<const int> half_edges(std::size_t edge) const {
    return {half_edges_.data() + starts_[edge], half_edges_.data() + starts_[edge + 1]};
  }

 private:
  std::vector<int> half_edges_;
  std::vector<std::size_t> starts_;
};

// Union-find with path halving; the smaller number represents.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  int find(int x) {
    while (parent_[x] != x) x = parent_[x] = parent_[parent_[x]];
    return x;
  }
  void join(int a, int b) {
    a = find(a);
    b = find(b);
    if (a != b) parent_[a < b ? b : a] = a < b ? a : b;
  }

 private:
  std::vector<int> parent_;
};

}  // namespace skinframe
