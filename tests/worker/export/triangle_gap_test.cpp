// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/export/triangle_gap.h"

#include <gtest/gtest.h>

#include <random>

#include "worker/export/crossings.h"

namespace skinframe {
namespace {

const Corners kGround{Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(4, 0, 0), Eigen::Vector3d(0, 4, 0)};

TEST(TriangleGap, PierceIsNotApartAndAboveIs) {
  EXPECT_FALSE(
      are_apart(kGround, {Eigen::Vector3d(1, 1, -1), Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(2, 1, 1)}));
  EXPECT_TRUE(
      are_apart(kGround, {Eigen::Vector3d(1, 1, 0.1), Eigen::Vector3d(1, 2, 1), Eigen::Vector3d(2, 1, 1)}));
}

TEST(TriangleGap, TouchingCountsAsNotApart) {
  EXPECT_FALSE(
      are_apart(kGround, {Eigen::Vector3d(1, 1, 0), Eigen::Vector3d(1, 2, 1), Eigen::Vector3d(2, 1, 1)}));
}

TEST(TriangleGap, InOnePlaneTheSidesDecide) {
  const Corners beside{Eigen::Vector3d(4, 4, 0), Eigen::Vector3d(5, 4, 0), Eigen::Vector3d(4, 5, 0)};
  const Corners over{Eigen::Vector3d(1, 1, 0), Eigen::Vector3d(5, 4, 0), Eigen::Vector3d(4, 5, 0)};
  EXPECT_TRUE(are_apart(kGround, beside));
  EXPECT_FALSE(are_apart(kGround, over));
}

TEST(TriangleGap, NeighboursAboutACornerMeetThereOnlyUnlessOneFoldsOver) {
  EXPECT_TRUE(meet_in_their_corner_only(
      kGround, {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(-4, 0, 0), Eigen::Vector3d(0, -4, 0)}));
  EXPECT_FALSE(meet_in_their_corner_only(
      kGround, {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(3, 1, 0), Eigen::Vector3d(1, 3, 0)}));
  EXPECT_FALSE(meet_in_their_corner_only(
      kGround, {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 1, -1), Eigen::Vector3d(1, 1, 1)}));
}

TEST(TriangleGap, NeverCallsApartWhatExactPredicatesCallCrossing) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> at(0.0f, 1.0f);
  int crossing = 0, apart = 0;
  for (int i = 0; i < 3000; ++i) {
    TriangleMesh mesh;
    for (int v = 0; v < 6; ++v) mesh.vertices.emplace_back(at(random), at(random), at(random));
    mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
    const auto corners = [&](int first) -> Corners {
      return {mesh.vertices[first], mesh.vertices[first + 1], mesh.vertices[first + 2]};
    };
    const bool crosses = !crossing_triangles(mesh).empty(), clear = are_apart(corners(0), corners(3));
    crossing += crosses;
    apart += clear;
    ASSERT_NE(crosses, clear);  // random corners are never within a millionth of each other
  }
  EXPECT_GT(crossing, 300);
  EXPECT_GT(apart, 300);
}

TEST(TriangleGap, DistanceIsToCornerSideOrInside) {
  EXPECT_DOUBLE_EQ(squared_distance({1, 1, 3}, kGround), 9.0);
  EXPECT_DOUBLE_EQ(squared_distance({-3, -4, 0}, kGround), 25.0);
  EXPECT_DOUBLE_EQ(squared_distance({2, -2, 0}, kGround), 4.0);
  EXPECT_NEAR(squared_distance({3, 3, 0}, kGround), 2.0, 1e-12);
}

}  // namespace
}  // namespace skinframe
