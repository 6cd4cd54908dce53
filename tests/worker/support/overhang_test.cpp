// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/support/overhang.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/worker/support/small_prints.h"

namespace skinframe {
namespace {

using test::bridges_10_mm;
constexpr double kSkin = 1.0;

// The distance to the surface of a box of half sizes `half` about a centre, negative inside.
double box_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& centre, const Eigen::Vector3d& half) {
  const Eigen::Vector3d q = (p - centre).cwiseAbs() - half;
  return q.cwiseMax(0.0).norm() + std::min(q.maxCoeff(), 0.0);
}

PrintedBody of_depth(const std::function<double(const Eigen::Vector3d&)>& depth_mm) {
  const auto outward = [depth_mm](const Eigen::Vector3d& p) {
    Eigen::Vector3d out;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d e = 0.1 * Eigen::Vector3d::Unit(k);
      out[k] = (depth_mm(p - e) - depth_mm(p + e)) / 0.2;
    }
    return out;
  };
  return {depth_mm, outward, kSkin, 0.0, 0.25};
}

// A box of 42 x 42 x 40 mm on the plate: its cavity has a level roof of 40 x 40 mm, 39 mm up.
PrintedBody box_body() {
  return of_depth([](const Eigen::Vector3d& p) { return -box_distance(p, {0, 0, 20}, {21, 21, 20}); });
}
const BoundingBox kBox{{-21, -21, 0}, {21, 21, 40}};

TEST(Overhang, ALevelRoofReachesHalfABridgeFromItsWalls) {
  const FlatSkin skin(box_body(), kBox, bridges_10_mm(), 1.0);
  const Overhang overhang = skin.measure();
  // 40 x 40 mm, and beyond 5 mm from the walls 30 x 30 mm, to a cell at each side.
  EXPECT_NEAR(overhang.roof_mm2 + 4 * 40 * 1.5, 1600, 250);
  EXPECT_NEAR(overhang.roof_beyond_mm2, 900, 130);
  EXPECT_EQ(overhang.underside_mm2, 0.0);
  for (const FlatCell& cell : skin.cells()) EXPECT_NEAR(cell.at_mm.z(), 39.0, 0.02);
}

TEST(Overhang, PointsAreChosenUntilTheWholeRoofIsReached) {
  FlatSkin skin(box_body(), kBox, bridges_10_mm(), 1.0);
  const auto points = skin.points_to_hold(1000);
  EXPECT_EQ(skin.measure().roof_beyond_mm2, 0.0);
  EXPECT_GE(points.size(), 900 / (5 * 5 * std::numbers::pi));
  EXPECT_LE(points.size(), 60u);
  for (const Eigen::Vector3d& p : points) EXPECT_NEAR(p.z(), 39.5, 0.02);

  // The same points as upper ends of struts hold it as well.
  FlatSkin held(box_body(), kBox, bridges_10_mm(), 1.0);
  std::vector<Holder> holders;
  for (const Eigen::Vector3d& p : points) holders.push_back({p, 0.4, true});
  held.hold(holders);
  EXPECT_EQ(held.measure().roof_beyond_mm2, 0.0);
}

TEST(Overhang, AConeThatLeansNoFlatterThanTheLimitHoldsItself) {
  // A round tent: its roof leans 40 degrees from the vertical.
  const double lean = 40 * std::numbers::pi / 180;
  const PrintedBody tent = of_depth([lean](const Eigen::Vector3d& p) {
    return std::min(p.z(), (40 - p.z()) * std::sin(lean) - p.head<2>().norm() * std::cos(lean));
  });
  const FlatSkin skin(tent, {{-34, -34, 0}, {34, 34, 40}}, bridges_10_mm(), 1.0);
  EXPECT_LT(skin.measure().roof_beyond_mm2, 5.0);
  EXPECT_LT(skin.measure().roof_mm2, 30.0);
}

TEST(Overhang, ABulgeThatHangsFromTheRoofStartsInTheAir) {
  // A ball of solid under the roof of the box: nothing reaches its lowest part from above.
  const PrintedBody body = of_depth([](const Eigen::Vector3d& p) {
    const double box = -box_distance(p, {0, 0, 20}, {21, 21, 20});
    const double to_ball = (p - Eigen::Vector3d(0, 0, 39)).norm() - 8.0;
    return std::min(box, to_ball + kSkin);
  });
  FlatSkin skin(body, kBox, bridges_10_mm(), 1.0);
  double lowest = 100, way = 0;
  for (const FlatCell& cell : skin.cells())
    if (cell.at_mm.z() < lowest) {
      lowest = cell.at_mm.z();
      way = cell.way_mm;
    }
  EXPECT_NEAR(lowest, 31.0, 0.1);
  EXPECT_TRUE(std::isinf(way));
  const auto points = skin.points_to_hold(1000);
  EXPECT_NEAR(points.front().z(), 31.5, 0.1) << "the lowest of what nothing reaches comes first";
}

TEST(Overhang, AnUndersideIsOneOfM) {
  const PrintedBody table = test::table_top();
  const FlatSkin skin(table, {{-10, -10, 30}, {10, 10, 32}}, bridges_10_mm(), 1.0);
  EXPECT_GT(skin.measure().underside_mm2, 300.0);
  EXPECT_EQ(skin.measure().underside_beyond_mm2, skin.measure().underside_mm2);
  EXPECT_EQ(skin.measure().roof_mm2, 0.0);
}

TEST(Overhang, AStrutWithinMHoldsNoUnderside) {
  FlatSkin skin(test::table_top(), {{-10, -10, 30}, {10, 10, 32}}, bridges_10_mm(), 1.0);
  skin.hold({{{0, 0, 31}, 0.4, true}});
  EXPECT_EQ(skin.measure().underside_beyond_mm2, skin.measure().underside_mm2);
  skin.hold({{{0, 0, 31}, 0.4, false}});
  EXPECT_LT(skin.measure().underside_beyond_mm2, skin.measure().underside_mm2);
}

TEST(Overhang, OnlyStrutsThatSupportThemselvesHoldTheSkin) {
  Frame frame;
  frame.nodes_mm = {{0, 0, 39.5}, {0, 0, 10}, {30, 0, 30}};
  frame.struts = {{0, 1, false}, {0, 2, false}};
  const auto holders = holders_of(frame, {0.4, 0.4}, SupportPlan{}, bridges_10_mm());
  ASSERT_EQ(holders.size(), 1u);
  EXPECT_EQ(holders[0].at_mm.z(), 39.5);
}

}  // namespace
}  // namespace skinframe
