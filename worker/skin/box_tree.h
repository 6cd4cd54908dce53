// SPDX-License-Identifier: GPL-3.0-or-later
// Which boxes are near, which a line meets: a binary tree of axis-parallel boxes, halved by count at the
// middle of the longest side. The same tree at any number of threads; reads from many threads at once are
// safe.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace skinframe {

// The box in floats, rounded outwards.
Eigen::AlignedBox3f box_around(const Eigen::AlignedBox3d& box);

class BoxTree {
 public:
  explicit BoxTree(const std::vector<Eigen::AlignedBox3f>& boxes);

  // visit(item) of every item whose box meets what meets(box) does; meets must hold for a box around a box
  // that it holds for.
  template <class Meets, class Visit>
  void search(Meets meets, Visit visit) const;

  // Goes through the items whose boxes are nearer to the point than `least`, nearer boxes first; visit(item)
  // may lower `least`. Squared distances, double.
  template <class Visit>
  void approach(const Eigen::Vector3d& point, double& least, Visit visit) const;

 private:
  struct Node {
    Eigen::AlignedBox3f box;
    int first = 0, end = 0;  // items of order_
    int right = -1;          // the second child; the first follows the node. -1: a leaf
  };
  struct Centre {
    std::array<float, 3> at;
    int item;
  };

  static constexpr int kLeaf = 4;         // most items of a leaf
  static constexpr int kParallel = 8192;  // items of a node above which its halves go side by side

  static int nodes_for(int items);
  void build(const std::vector<Eigen::AlignedBox3f>& boxes, std::vector<Centre>& centres, int node, int first,
             int end);
  static double squared_distance(const Eigen::AlignedBox3f& box, const Eigen::Vector3d& p) {
    double sum = 0.0;
    for (int k = 0; k < 3; ++k) {
      const double out = std::max({0.0, box.min()[k] - p[k], p[k] - box.max()[k]});
      sum += out * out;
    }
    return sum;
  }

  std::vector<Node> nodes_;
  std::vector<int> order_;                    // items by leaf
  std::vector<Eigen::AlignedBox3f> leaf_of_;  // their boxes, in that order
};

}  // namespace skinframe

#include "worker/skin/box_tree_search.h"
