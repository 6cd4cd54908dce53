// SPDX-License-Identifier: GPL-3.0-or-later
// The searches of box_tree.h.
#pragma once

#include <algorithm>
#include <cmath>

#include "worker/skin/box_tree.h"

namespace skinframe {

template <class Meets, class Visit>
void BoxTree::search(Meets meets, Visit visit) const {
  std::array<int, 64> todo{};
  int size = 0;
  if (!nodes_.empty()) todo[size++] = 0;
  while (size > 0) {
    const Node& node = nodes_[todo[--size]];
    if (!meets(node.box)) continue;
    if (node.right < 0) {
      for (int i = node.first; i < node.end; ++i)
        if (meets(leaf_of_[i])) visit(order_[i]);
      continue;
    }
    todo[size++] = node.right;
    todo[size++] = static_cast<int>(&node - nodes_.data()) + 1;
  }
}

template <class Visit>
void BoxTree::approach(const Eigen::Vector3d& point, double& least, Visit visit) const {
  std::array<std::pair<int, double>, 64> todo;
  int size = 0;
  if (!nodes_.empty()) todo[size++] = {0, squared_distance(nodes_[0].box, point)};
  while (size > 0) {
    const auto [at, distance] = todo[--size];
    if (distance >= least) continue;
    const Node& node = nodes_[at];
    if (node.right < 0) {
      for (int i = node.first; i < node.end; ++i)
        if (squared_distance(leaf_of_[i], point) < least) visit(order_[i]);
      continue;
    }
    std::pair<int, double> near{at + 1, squared_distance(nodes_[at + 1].box, point)};
    std::pair<int, double> far{node.right, squared_distance(nodes_[node.right].box, point)};
    if (far.second < near.second) std::swap(near, far);
    todo[size++] = far;
    todo[size++] = near;
  }
}

}  // namespace skinframe
