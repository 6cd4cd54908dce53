// SPDX-License-Identifier: GPL-3.0-or-later
// A kd-tree over fixed points: nearest neighbours and all points in a ball. Ties are broken by index, so
// answers do not depend on how the tree was built. Reads from many threads at once are safe.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace skinframe {

class PointTree {
 public:
  explicit PointTree(std::vector<Eigen::Vector3d> points);

  bool empty() const { return points_.empty(); }
  const Eigen::Vector3d& point(int i) const { return points_[i]; }

  int nearest(const Eigen::Vector3d& query) const;  // -1 when there are no points
  // The same, sooner where the point guessed is near. Of at least one point.
  int nearest_by_guess(const Eigen::Vector3d& query, int guess) const;
  std::vector<int> nearest(const Eigen::Vector3d& query,
                           int count) const;  // nearest first; fewer when there are fewer
  std::vector<int> within(const Eigen::Vector3d& query, double radius) const;  // ascending index

 private:
  void build(int begin, int end);
  // Calls visit(index, squared distance) for points that may lie within *bound of the query (squared); the
  // visitor may lower the bound.
  template <class Visit>
  void search(int begin, int end, const Eigen::Vector3d& query, const double* bound, Visit& visit) const;

  std::vector<Eigen::Vector3d> points_;
  std::vector<int> order_;           // the middle of each range is its node
  std::vector<unsigned char> axis_;  // of that node, by place in order_
};

}  // namespace skinframe
