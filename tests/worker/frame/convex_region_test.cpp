// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/frame/convex_region.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/worker/fixture/skin_of.h"
#include "tests/worker/skin/bodies.h"
#include "worker/frame/sample_frame.h"

namespace skinframe {
namespace {

using test::skin_of;

bool holds(const std::vector<HalfSpace>& region, const Eigen::Vector3d& p, double tolerance) {
  for (const HalfSpace& h : region) {
    if (h.normal.dot(p) > h.offset_mm + tolerance) return false;
  }
  return true;
}

TEST(RequiredDepth, GrowsFromTheSkinEndToTheRadius) {
  EXPECT_EQ(required_depth_mm(0.5, 0.0), 0.0);
  EXPECT_DOUBLE_EQ(required_depth_mm(0.5, 1.0), 0.2);
  EXPECT_EQ(required_depth_mm(0.5, 100.0), 0.5);
}

// One strut between two internal nodes in a hollow box of 38 x 38 x 18 mm.
class StrutInABox : public testing::Test {
 protected:
  static void SetUpTestSuite() { skin_ = new Skin(skin_of(bodies::box(40, 40, 20))); }
  static void TearDownTestSuite() { delete skin_; }
  static Frame strut(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    Frame frame;
    frame.nodes_mm = {a, b};
    frame.struts = {{0, 1, false}};
    return frame;
  }
  static Skin* skin_;
};
Skin* StrutInABox::skin_ = nullptr;

TEST_F(StrutInABox, IsInsideUpToItsClearance) {
  const Frame frame = strut({10, 20, 4}, {30, 20, 4});  // 3 mm above M1's floor
  EXPECT_TRUE(struts_inside(frame, {2.9}, *skin_));
  EXPECT_FALSE(struts_inside(frame, {3.3}, *skin_));
  EXPECT_NEAR(worst_strut_excess_mm(frame, {3.3}, *skin_), 0.3, 0.05);
  EXPECT_NEAR(strut_clearance_mm(frame, *skin_)[0], 3.0 + inside_tolerance_mm(*skin_), 0.05);
}

TEST_F(StrutInABox, RegionIsTheBoxLessTheRadius) {
  const auto regions = convex_regions(strut({10, 20, 4}, {30, 20, 4}), {1.0}, *skin_);
  const Eigen::Vector3d a(10, 20, 4);
  EXPECT_TRUE(holds(regions[0], a, 1e-9));
  EXPECT_TRUE(holds(regions[0], {10, 20, 2.2}, 0.0));   // 1.2 above the floor of M1
  EXPECT_FALSE(holds(regions[0], {10, 20, 1.8}, 0.0));  // 0.8 above it
}

TEST_F(StrutInABox, NoTwoEndsInTheirRegionsLeaveTheBox) {
  const Frame frame = strut({10, 10, 4}, {30, 32, 15});
  const auto regions = convex_regions(frame, {0.5}, *skin_);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-10.0, 10.0);
  int tried = 0;
  while (tried < 300) {
    Frame moved = frame;
    for (auto& p : moved.nodes_mm) p += Eigen::Vector3d(unit(random), unit(random), unit(random));
    if (!holds(regions[0], moved.nodes_mm[0], 0.0) || !holds(regions[1], moved.nodes_mm[1], 0.0)) continue;
    ++tried;
    ASSERT_TRUE(struts_inside(moved, {0.5}, *skin_)) << worst_strut_excess_mm(moved, {0.5}, *skin_);
  }
}

// On a whole frame in a body that is not convex.
TEST(ConvexRegions, WholeFrameStaysInsideATorusWhileNodesStayInTheirRegions) {
  const Skin skin = skin_of(bodies::torus(28, 11));
  RunContext context;
  FrameOptions options;
  options.plate.tensile_modulus_mpa = 1586;
  options.internal_nodes = 40;
  const auto sampled = sample_frame(skin, options, context);
  ASSERT_TRUE(sampled.ok()) << sampled.error().message;
  const Frame& frame = sampled->frame;
  const std::vector<double> radii(frame.struts.size(), 0.5);
  const auto regions = convex_regions(frame, radii, skin);
  ASSERT_EQ(regions.size(), frame.nodes_mm.size());
  for (std::size_t i = 0; i < regions.size(); ++i) {
    if (static_cast<int>(i) < frame.skin_node_count) {
      EXPECT_TRUE(regions[i].empty());
      continue;
    }
    EXPECT_GE(regions[i].size(), 6u);
    EXPECT_TRUE(holds(regions[i], frame.nodes_mm[i], 1e-9));
    for (const HalfSpace& h : regions[i]) EXPECT_NEAR(h.normal.norm(), 1.0, 1e-12);
  }
  std::mt19937 random(5);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int round = 0; round < 20; ++round) {
    Frame moved = frame;
    for (std::size_t i = frame.skin_node_count; i < regions.size(); ++i) {
      // The furthest of some steps in a random direction that the region lets it go.
      const Eigen::Vector3d way = 8.0 * Eigen::Vector3d(unit(random), unit(random), unit(random));
      for (double t = 1.0; t > 0.01; t *= 0.8) {
        if (!holds(regions[i], frame.nodes_mm[i] + t * way, 0.0)) continue;
        moved.nodes_mm[i] += t * way;
        break;
      }
    }
    ASSERT_LE(worst_strut_excess_mm(moved, radii, skin), 2.0 * inside_tolerance_mm(skin))
        << "round " << round;
  }
}

}  // namespace
}  // namespace skinframe
