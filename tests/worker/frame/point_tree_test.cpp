// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/frame/point_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace skinframe {
namespace {

// The slow oracle: all points by distance, then index.
std::vector<int> by_distance(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& query) {
  std::vector<int> order(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  std::sort(order.begin(), order.end(), [&](int i, int j) {
    const double a = (points[i] - query).squaredNorm(), b = (points[j] - query).squaredNorm();
    return a != b ? a < b : i < j;
  });
  return order;
}

TEST(PointTree, AgreesWithLookingAtAllPointsAlsoOnTies) {
  std::mt19937 random(7);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 500; ++i) points.emplace_back(random() % 8, random() % 8, random() % 8);
  const PointTree tree(points);
  for (int q = 0; q < 200; ++q) {
    const Eigen::Vector3d query(random() % 9 - 0.5, random() % 9, random() % 9);
    auto expected = by_distance(points, query);
    EXPECT_EQ(tree.nearest(query), expected.front());
    std::vector<int> ball;
    for (int i : expected) {
      if ((points[i] - query).norm() <= 2.0) ball.push_back(i);
    }
    std::sort(ball.begin(), ball.end());
    EXPECT_EQ(tree.within(query, 2.0), ball);
    expected.resize(13);
    EXPECT_EQ(tree.nearest(query, 13), expected);
  }
}

TEST(PointTree, EmptyHasNoNearest) {
  const PointTree tree({});
  EXPECT_EQ(tree.nearest(Eigen::Vector3d::Zero()), -1);
  EXPECT_TRUE(tree.nearest(Eigen::Vector3d::Zero(), 3).empty());
  EXPECT_TRUE(tree.within(Eigen::Vector3d::Zero(), 1e9).empty());
}

}  // namespace
}  // namespace skinframe
