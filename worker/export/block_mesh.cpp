// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/export/block_mesh.h"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace skinframe {
namespace {

// What number a vertex of the whole mesh has in the block: a hash table with open addressing.
class NumberTable {
 public:
  explicit NumberTable(std::size_t most) : slots_(std::bit_ceil(2 * most + 2), {-1, 0}) {}

  // The number it has, or `next` from now on.
  int number_of(int vertex, int next) {
    std::size_t at = static_cast<std::uint32_t>(vertex) * std::uint64_t{0x9E3779B97F4A7C15} >> 20;
    while (true) {
      auto& [known, number] = slots_[at & (slots_.size() - 1)];
      if (known == vertex) return number;
      if (known < 0) {
        known = vertex;
        return number = next;
      }
      ++at;
    }
  }

 private:
  std::vector<std::pair<int, int>> slots_;
};

}  // namespace

BlockMesh::BlockMesh(ThinningState& state, const ThinningBlock& block) : state_(state), block_(block) {
  number_vertices();
  link_triangles();
}

void BlockMesh::number_vertices() {
  const auto& all = state_.mesh->triangles;
  own_ = static_cast<int>(block_.own.size());
  NumberTable table(3 * (block_.own.size() + block_.beside.size()));
  for (const auto* list : {&block_.own, &block_.beside}) {
    for (int t : *list) {
      auto& corners = triangles_.emplace_back();
      for (int k = 0; k < 3; ++k) {
        const int v = all[t][k];
        corners[k] = table.number_of(v, static_cast<int>(numbers_.size()));
        if (corners[k] == static_cast<int>(numbers_.size())) {
          numbers_.push_back(v);
          places_.push_back(state_.mesh->vertices[v]);
          locked_.push_back(0);
        }
        if (list == &block_.beside) locked_[corners[k]] = 1;
      }
    }
  }
  if (state_.exact_stay)
    for (std::size_t v = 0; v < numbers_.size(); ++v) locked_[v] |= is_exact(static_cast<int>(v));
  slots_.resize(triangles_.size());
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const auto& c = triangles_[t];
    keep_shape_of(static_cast<int>(t), {places_[c[0]], places_[c[1]], places_[c[2]]});
  }
  seen_.assign(numbers_.size(), 0);
  dead_.assign(numbers_.size(), 0);
}

// Lists of the own triangles about each vertex (by corner, 3 t + k), and of the points of each.
void BlockMesh::link_triangles() {
  first_corner_.assign(numbers_.size(), -1);
  next_corner_.assign(3 * own_, -1);
  first_point_.assign(own_, -1);
  for (int t = own_ - 1; t >= 0; --t) {
    for (int k = 2; k >= 0; --k) {
      int& first = first_corner_[triangles_[t][k]];
      next_corner_[3 * t + k] = first;
      first = 3 * t + k;
    }
    const int global = block_.own[t];
    for (int i = state_.first_point[global]; i < state_.first_point[global + 1]; ++i) {
      points_.push_back(state_.points_of[i]);
      next_point_.push_back(first_point_[t]);
      first_point_[t] = static_cast<int>(points_.size()) - 1;
    }
  }
}

void BlockMesh::gather(int v, std::vector<int>& around) {
  around.clear();
  int* link = &first_corner_[v];
  while (*link >= 0) {
    if (slots_[*link / 3].alive) {
      around.push_back(*link / 3);
      link = &next_corner_[*link];
    } else {
      *link = next_corner_[*link];
    }
  }
}

void BlockMesh::neighbours(int v, const std::vector<int>& around, std::vector<int>& near) {
  near.clear();
  ++vertex_stamp_;
  for (int t : around) {
    for (int w : triangles_[t]) {
      if (w == v || seen_[w] == vertex_stamp_) continue;
      seen_[w] = vertex_stamp_;
      near.push_back(w);
    }
  }
}

void BlockMesh::merge(int u, int v, const Eigen::Vector3d& place, const std::vector<int>& star,
                      const std::vector<ChangedTriangle>& changed,
                      const std::vector<std::pair<int, int>>& moved) {
  for (int t : star) first_point_[t] = -1;
  for (const auto& [p, t] : moved) {
    next_point_[p] = first_point_[t];
    first_point_[t] = p;
  }
  for (int t : star) {
    if (has(t, u) && has(t, v)) slots_[t].alive = false;
    std::replace(triangles_[t].begin(), triangles_[t].end(), v, u);
  }
  int* end = &first_corner_[u];
  while (*end >= 0) end = &next_corner_[*end];
  *end = first_corner_[v];
  first_corner_[v] = -1;
  places_[u] = place;
  dead_[v] = 1;
  locked_[v] = 1;
  for (const ChangedTriangle& triangle : changed) keep_shape_of(triangle.triangle, triangle.corners);
}

void BlockMesh::write_back() const {
  TriangleMesh& mesh = *state_.mesh;
  for (std::size_t v = 0; v < places_.size(); ++v) {
    if (!locked_[v]) mesh.vertices[numbers_[v]] = places_[v];
  }
  for (int t = 0; t < own_; ++t) {
    const int global = block_.own[t];
    state_.gone[global] = !slots_[t].alive;
    for (int k = 0; k < 3; ++k) mesh.triangles[global][k] = numbers_[triangles_[t][k]];
    for (int p = first_point_[t]; p >= 0; p = next_point_[p]) state_.points[points_[p]].triangle = global;
  }
}

}  // namespace skinframe
