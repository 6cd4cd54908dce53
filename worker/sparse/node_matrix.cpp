// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/sparse/node_matrix.h"

#include <algorithm>
#include <limits>

#include "worker/run/result.h"

namespace skinframe {

NodeMatrix::NodeMatrix(int width, const std::vector<char>& is_free, std::vector<std::pair<int, int>> links)
    : width_(width), rows_(is_free.size(), -1), first_row_{0} {
  SKINFRAME_CHECK(width > 0 && is_free.size() % width == 0);
  int free = 0;
  for (std::size_t i = 0; i < is_free.size(); ++i) {
    if (is_free[i]) rows_[i] = free++;
    if ((i + 1) % width == 0) first_row_.push_back(free);
  }
  link(std::move(links));
  make_pattern();
}

void NodeMatrix::link(std::vector<std::pair<int, int>> links) {
  for (auto& [a, b] : links)
    if (a > b) std::swap(a, b);
  for (int v = 0; v < node_count(); ++v) links.emplace_back(v, v);
  std::sort(links.begin(), links.end());
  links.erase(std::unique(links.begin(), links.end()), links.end());
  first_link_.assign(node_count() + 1, 0);
  for (const auto& [a, b] : links) {
    ++first_link_[a + 1];
    linked_.push_back(b);
  }
  for (int v = 0; v < node_count(); ++v) first_link_[v + 1] += first_link_[v];
}

void NodeMatrix::make_pattern() {
  lower_.resize(rows(), rows());
  above_.resize(linked_.size());
  std::size_t entries = 0;
  for (int v = 0; v < node_count(); ++v) {
    int above = 0;
    for (int l = first_link_[v]; l < first_link_[v + 1]; ++l) {
      above_[l] = above;
      above += free_of(linked_[l]);
    }
    for (int k = 0; k < free_of(v); ++k) {  // the block on the diagonal is a triangle
      entries += above - k;
      SKINFRAME_CHECK(entries <= static_cast<std::size_t>(std::numeric_limits<int>::max()));
      lower_.outerIndexPtr()[first_row_[v] + k + 1] = static_cast<int>(entries);
    }
  }
  lower_.resizeNonZeros(static_cast<Eigen::Index>(entries));
  int* row = lower_.innerIndexPtr();
  for (int v = 0; v < node_count(); ++v)
    for (int k = 0; k < free_of(v); ++k)
      for (const int w : linked_from(v))
        for (int i = w == v ? k : 0; i < free_of(w); ++i) *row++ = first_row_[w] + i;
  std::fill_n(lower_.valuePtr(), entries, 0.0);
}

int NodeMatrix::link_of(int node, int later) const {
  const auto begin = linked_.begin() + first_link_[node], end = linked_.begin() + first_link_[node + 1];
  const auto it = std::lower_bound(begin, end, later);
  SKINFRAME_CHECK(it != end && *it == later);
  return static_cast<int>(it - linked_.begin());
}

void NodeMatrix::add(std::span<const int> nodes, const Eigen::Ref<const Eigen::MatrixXd>& stiffness) {
  for (std::size_t q = 0; q < nodes.size(); ++q)
    for (std::size_t p = 0; p < nodes.size(); ++p) {
      const int v = nodes[q], w = nodes[p];
      if (w < v) continue;
      const int above = above_[link_of(v, w)];
      for (int k = 0; k < width_; ++k) {
        const int column = rows_[width_ * v + k];
        if (column < 0) continue;
        // A column misses what stands above the diagonal: as many entries as columns before it in its block.
        double* values =
            lower_.valuePtr() + lower_.outerIndexPtr()[column] + above - (column - first_row_[v]);
        for (int i = 0; i < width_; ++i) {
          const int row = rows_[width_ * w + i];
          if (row >= column)
            values[row - first_row_[w]] += stiffness(static_cast<Eigen::Index>(width_ * p + i),
                                                     static_cast<Eigen::Index>(width_ * q + k));
        }
      }
    }
}

}  // namespace skinframe
