// SPDX-License-Identifier: GPL-3.0-or-later
// The searches of box_tree.h.
#pragma once

#include <tbb/parallel_invoke.h>

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

template <class Keep>
void BoxTree::judge(int i, int j, const Keep& keep, Pairs& out) const {
  if (!leaf_of_[i].intersects(leaf_of_[j])) return;
  const std::pair<int, int> pair = std::minmax(order_[i], order_[j]);
  if (keep(pair.first, pair.second)) out.push_back(pair);
}

template <class Keep>
void BoxTree::add_between(int a, int b, const Keep& keep, Pairs& out) const {
  const Node &x = nodes_[a], &y = nodes_[b];
  if (!x.box.intersects(y.box)) return;
  if (x.right < 0 && y.right < 0) {
    for (int i = x.first; i < x.end; ++i) {
      if (!leaf_of_[i].intersects(y.box)) continue;
      for (int j = y.first; j < y.end; ++j) judge(i, j, keep, out);
    }
  } else if (y.right < 0 || (x.right >= 0 && x.end - x.first >= y.end - y.first)) {
    add_between(a + 1, b, keep, out);
    add_between(x.right, b, keep, out);
  } else {
    add_between(a, b + 1, keep, out);
    add_between(a, y.right, keep, out);
  }
}

template <class Keep>
void BoxTree::add_within(int node, const Keep& keep, Pairs& out) const {
  const Node& x = nodes_[node];
  if (x.right < 0) {
    for (int i = x.first; i < x.end; ++i)
      for (int j = x.first; j < i; ++j) judge(i, j, keep, out);
    return;
  }
  add_within(node + 1, keep, out);
  add_within(x.right, keep, out);
  add_between(node + 1, x.right, keep, out);
}

template <class Keep>
BoxTree::Pairs BoxTree::between(int a, int b, const Keep& keep) const {
  const Node &x = nodes_[a], &y = nodes_[b];
  Pairs pairs, more;
  if (!x.box.intersects(y.box)) return pairs;
  if (std::max(x.end - x.first, y.end - y.first) <= kParallel || (x.right < 0 && y.right < 0)) {
    add_between(a, b, keep, pairs);
    return pairs;
  }
  const bool halve_x = y.right < 0 || (x.right >= 0 && x.end - x.first >= y.end - y.first);
  tbb::parallel_invoke([&] { pairs = halve_x ? between(a + 1, b, keep) : between(a, b + 1, keep); },
                       [&] { more = halve_x ? between(x.right, b, keep) : between(a, y.right, keep); });
  pairs.insert(pairs.end(), more.begin(), more.end());
  return pairs;
}

template <class Keep>
BoxTree::Pairs BoxTree::within(int node, const Keep& keep) const {
  const Node& x = nodes_[node];
  Pairs pairs, more, across;
  if (x.end - x.first <= kParallel) {
    add_within(node, keep, pairs);
    return pairs;
  }
  tbb::parallel_invoke([&] { pairs = within(node + 1, keep); }, [&] { more = within(x.right, keep); },
                       [&] { across = between(node + 1, x.right, keep); });
  pairs.insert(pairs.end(), more.begin(), more.end());
  pairs.insert(pairs.end(), across.begin(), across.end());
  return pairs;
}

template <class Keep>
std::vector<std::pair<int, int>> BoxTree::pairs(Keep keep) const {
  Pairs found;
  if (!nodes_.empty()) found = within(0, keep);
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace skinframe
