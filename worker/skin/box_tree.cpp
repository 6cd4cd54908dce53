// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/skin/box_tree.h"

#include <tbb/parallel_invoke.h>

#include <cmath>
#include <limits>

namespace skinframe {

Eigen::AlignedBox3f box_around(const Eigen::AlignedBox3d& box) {
  constexpr float kFar = std::numeric_limits<float>::infinity();
  Eigen::AlignedBox3f around(box.min().cast<float>(), box.max().cast<float>());
  for (int k = 0; k < 3; ++k) {
    if (around.min()[k] > box.min()[k]) around.min()[k] = std::nextafter(around.min()[k], -kFar);
    if (around.max()[k] < box.max()[k]) around.max()[k] = std::nextafter(around.max()[k], kFar);
  }
  return around;
}

BoxTree::BoxTree(const std::vector<Eigen::AlignedBox3f>& boxes) {
  const int items = static_cast<int>(boxes.size());
  if (items == 0) return;
  std::vector<Centre> centres(boxes.size());
  for (int i = 0; i < items; ++i) {
    const Eigen::Vector3f at = 0.5f * (boxes[i].min() + boxes[i].max());
    centres[i] = {{at.x(), at.y(), at.z()}, i};
  }
  nodes_.resize(nodes_for(items));
  build(boxes, centres, 0, 0, items);
  order_.reserve(boxes.size());
  leaf_of_.reserve(boxes.size());
  for (const Centre& centre : centres) {
    order_.push_back(centre.item);
    leaf_of_.push_back(boxes[centre.item]);
  }
}

int BoxTree::nodes_for(int items) {
  // Halves differ by one at most, so two sizes a level: counted side by side.
  int leaves = 1, low = items, high_count = 0;  // `leaves` nodes of `low` or low + 1 items, so many of these
  int nodes = 1;
  while (low + (high_count > 0) > kLeaf) {
    // Nodes of at most kLeaf items stop; where both sizes stand on the two sides of the limit, count apart.
    if (low <= kLeaf) return nodes + 2 * high_count;
    const int low_count = leaves - high_count;
    // low -> floor, ceil of halves; low + 1 likewise.
    high_count = low % 2 == 0 ? high_count : low_count + 2 * high_count;
    low /= 2;
    leaves *= 2;
    nodes += leaves;
  }
  return nodes;
}

void BoxTree::build(const std::vector<Eigen::AlignedBox3f>& boxes, std::vector<Centre>& centres, int node,
                    int first, int end) {
  Node& here = nodes_[node];
  here.first = first;
  here.end = end;
  if (end - first <= kLeaf) {
    for (int i = first; i < end; ++i) here.box.extend(boxes[centres[i].item]);
    return;
  }
  Eigen::AlignedBox3f box;
  for (int i = first; i < end; ++i)
    box.extend(Eigen::Vector3f(centres[i].at[0], centres[i].at[1], centres[i].at[2]));
  int axis = 0;
  box.sizes().maxCoeff(&axis);
  const int middle = first + (end - first) / 2;
  std::nth_element(centres.begin() + first, centres.begin() + middle, centres.begin() + end,
                   [axis](const Centre& a, const Centre& b) {
                     return a.at[axis] != b.at[axis] ? a.at[axis] < b.at[axis] : a.item < b.item;
                   });
  here.right = node + 1 + nodes_for(middle - first);
  const auto left = [&] { build(boxes, centres, node + 1, first, middle); };
  const auto right = [&] { build(boxes, centres, here.right, middle, end); };
  if (end - first > kParallel) {
    tbb::parallel_invoke(left, right);
  } else {
    left();
    right();
  }
  here.box = nodes_[node + 1].box.merged(nodes_[here.right].box);
}

}  // namespace skinframe
