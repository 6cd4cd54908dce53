// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/frame/point_tree.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace skinframe {

PointTree::PointTree(std::vector<Eigen::Vector3d> points) : points_(std::move(points)) {
  order_.resize(points_.size());
  axis_.resize(points_.size());
  std::iota(order_.begin(), order_.end(), 0);
  build(0, static_cast<int>(points_.size()));
}

void PointTree::build(int begin, int end) {
  if (end - begin < 1) return;
  Eigen::Vector3d low = points_[order_[begin]], high = low;
  for (int i = begin; i < end; ++i) {
    low = low.cwiseMin(points_[order_[i]]);
    high = high.cwiseMax(points_[order_[i]]);
  }
  int axis = 0;
  (high - low).maxCoeff(&axis);
  const int middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, [&](int i, int j) {
    return points_[i][axis] != points_[j][axis] ? points_[i][axis] < points_[j][axis] : i < j;
  });
  axis_[middle] = static_cast<unsigned char>(axis);
  build(begin, middle);
  build(middle + 1, end);
}

template <class Visit>
void PointTree::search(int begin, int end, const Eigen::Vector3d& query, const double* bound,
                       Visit& visit) const {
  if (begin >= end) return;
  const int middle = begin + (end - begin) / 2;
  const Eigen::Vector3d& p = points_[order_[middle]];
  visit(order_[middle], (p - query).squaredNorm());
  const double beyond = query[axis_[middle]] - p[axis_[middle]];
  const bool lower_first = beyond <= 0.0;
  if (lower_first)
    search(begin, middle, query, bound, visit);
  else
    search(middle + 1, end, query, bound, visit);
  if (beyond * beyond > *bound) return;
  if (lower_first)
    search(middle + 1, end, query, bound, visit);
  else
    search(begin, middle, query, bound, visit);
}

int PointTree::nearest(const Eigen::Vector3d& query) const {
  return points_.empty() ? -1 : nearest_by_guess(query, 0);
}

int PointTree::nearest_by_guess(const Eigen::Vector3d& query, int guess) const {
  int best = guess;
  double bound = (points_[guess] - query).squaredNorm();
  auto visit = [&](int i, double d2) {
    if (d2 < bound || (d2 == bound && i < best)) {
      best = i;
      bound = d2;
    }
  };
  search(0, static_cast<int>(points_.size()), query, &bound, visit);
  return best;
}

std::vector<int> PointTree::nearest(const Eigen::Vector3d& query, int count) const {
  std::vector<std::pair<double, int>> heap;  // the worst of the best on top
  double bound = std::numeric_limits<double>::infinity();
  auto visit = [&](int i, double d2) {
    if (static_cast<int>(heap.size()) == count) {
      if (std::pair(d2, i) >= heap.front()) return;
      std::pop_heap(heap.begin(), heap.end());
      heap.pop_back();
    }
    heap.emplace_back(d2, i);
    std::push_heap(heap.begin(), heap.end());
    if (static_cast<int>(heap.size()) == count) bound = heap.front().first;
  };
  if (count > 0) search(0, static_cast<int>(points_.size()), query, &bound, visit);
  std::sort_heap(heap.begin(), heap.end());
  std::vector<int> result;
  for (const auto& [d2, i] : heap) result.push_back(i);
  return result;
}

std::vector<int> PointTree::within(const Eigen::Vector3d& query, double radius) const {
  std::vector<int> result;
  const double bound = radius * radius;
  auto visit = [&](int i, double d2) {
    if (d2 <= bound) result.push_back(i);
  };
  search(0, static_cast<int>(points_.size()), query, &bound, visit);
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace skinframe
