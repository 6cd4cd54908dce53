// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/drain/opening.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "tests/worker/drain/hollow.h"

namespace skinframe {
namespace {

Opening below_the_origin() { return {Eigen::Vector3d::Zero(), -Eigen::Vector3d::UnitZ(), 10, 2, 3}; }

TEST(Opening, DistanceIsThatToTheCylinder) {
  const Opening opening = below_the_origin();  // z from -2 to 3
  EXPECT_EQ(distance_mm(opening, {9, 0, 0}), 0.0);
  EXPECT_NEAR(distance_mm(opening, {13, 0, 0}), 3.0, 1e-12);
  EXPECT_NEAR(distance_mm(opening, {0, 5, 7}), 4.0, 1e-12);
  EXPECT_NEAR(distance_mm(opening, {13, 0, 7}), 5.0, 1e-12);
  EXPECT_NEAR(distance_mm(opening, {0, 0, -2.5}), 0.5, 1e-12);
}

TEST(Opening, ASegmentThatPassesThroughIsAtNoDistance) {
  const Opening opening = below_the_origin();
  EXPECT_EQ(distance_mm(opening, {-50, 0, 1}, {50, 1, 2}), 0.0);
  EXPECT_NEAR(distance_mm(opening, {-50, 0, 5}, {50, 0, 5}), 2.0, 1e-9);
  EXPECT_NEAR(distance_mm(opening, {-50, 14, 0}, {50, 14, 0}), 4.0, 0.01);
  EXPECT_GT(distance_mm(opening, {500, 0, 0}, {600, 0, 0}), 100.0);
  EXPECT_NEAR(room_mm({opening}, {-50, 14, 0}, {50, 14, 0}), 4.0 - kStrutSlackMm, 0.01);
}

TEST(Opening, TheRimStandsOnM1AllAboutItAndItsChordsClearTheOpening) {
  const hollow::Body ball = hollow::make(bodies::sphere(24, 4));
  const Eigen::Vector3d axis = Eigen::Vector3d(0.3, -0.2, -1).normalized();
  const Opening opening{Eigen::Vector3d(0, 0, 24) + 24 * axis, axis, 5, 1.5, 3};
  const SharpCurve rim = rim_curve(opening, ball.skin);
  ASSERT_FALSE(rim.points_mm.empty());
  EXPECT_TRUE(rim.closed);
  EXPECT_EQ(rim.corners, kRimNodes);
  const std::size_t step = (rim.points_mm.size() - 1) / kRimNodes;
  for (int i = 0; i < kRimNodes; ++i) {
    const Eigen::Vector3d &p = rim.points_mm[i * step], &q = rim.points_mm[(i + 1) * step];
    EXPECT_NEAR((p - Eigen::Vector3d(0, 0, 24)).norm(), 23.0, 0.1);
    // A strut of radius h_S along the chord stays out.
    EXPECT_GE(distance_mm(opening, p, q), 1.0 + 0.5 * kRimSlackMm);
  }
}

TEST(Opening, ThereIsNoRimWhereM1EndsWithinIt) {
  const hollow::Body box = hollow::make(bodies::box(60, 60, 20));
  EXPECT_TRUE(rim_curve({{5, 5, 0}, -Eigen::Vector3d::UnitZ(), 8, 1, 3}, box.skin).points_mm.empty());
  EXPECT_FALSE(rim_curve({{30, 30, 0}, -Eigen::Vector3d::UnitZ(), 8, 1, 3}, box.skin).points_mm.empty());
}

}  // namespace
}  // namespace skinframe
