// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/skin/thin_parts.h"

#include <gtest/gtest.h>

#include "tests/worker/fixture/skin_of.h"
#include "tests/worker/skin/bodies.h"
#include "worker/skin/build_skin.h"

namespace skinframe {
namespace {

using test::skin_of;

// A block of 19.2 x 20 x 40 mm with a fin of `cells` x 1.2 mm and 20 mm height on it, as long as the block.
TriangleMesh block_with_fin(int cells) {
  return bodies::blocks({16, 8, 8}, {1.2, 5, 5},
                        [=](int x, int y, int) { return y < 4 || (x >= 8 && x < 8 + cells); });
}

TEST(ThinParts, ASheetOnABlockIsFoundWithItsVolumeThicknessAndPlace) {
  const ThinParts thin = skin_of(block_with_fin(1)).thin;
  // Points whose nearest surface is a rim, in triangles half as high as the fin is thick, look along the fin.
  const double rims = 1.2 * 1.2 / 4 * (40 + 2 * 20);
  const double truth = 1.2 * 20 * 40 - rims;
  EXPECT_NEAR(thin.volume_mm3, truth, 0.02 * truth);
  EXPECT_NEAR(thin.fraction, truth / (19.2 * 20 * 40 + 1.2 * 20 * 40), 0.001);
  ASSERT_EQ(thin.regions.size(), 1u);
  EXPECT_EQ(thin.regions[0].kind, ThinKind::kSheet);
  EXPECT_NEAR(thin.regions[0].mean_thickness_mm, 1.2, 0.05);
  EXPECT_LT((thin.regions[0].centre_mm - Eigen::Vector3d(8 * 1.2 + 0.6, 30.1, 20)).norm(), 0.3);
}

TEST(ThinParts, ARodOnABlockIsALimb) {
  const TriangleMesh body = bodies::blocks({17, 17, 10}, {1.2, 1.2, 5},
                                           [](int x, int y, int z) { return z < 4 || (x == 8 && y == 8); });
  const ThinParts thin = skin_of(body).thin;
  const double tip = 1.2 * 1.2 * 0.6 / 3;  // a pyramid of points nearest to the end of the rod
  const double truth = 1.2 * 1.2 * 30 - tip;
  EXPECT_NEAR(thin.volume_mm3, truth, 0.03 * truth);
  ASSERT_EQ(thin.regions.size(), 1u);
  EXPECT_EQ(thin.regions[0].kind, ThinKind::kLimb);
}

TEST(ThinParts, AWallThickerThanTwoSkinsIsNotThin) {
  EXPECT_EQ(skin_of(block_with_fin(2)).thin.volume_mm3, 0.0);
}

TEST(ThinParts, CreasesAndCornersAreNotThin) {
  const ThinParts thin = skin_of(bodies::box(30, 30, 30)).thin;
  EXPECT_EQ(thin.volume_mm3, 0.0);
  EXPECT_EQ(thin.region_count, 0);
}

TEST(ThinParts, TwoSheetsAreTwoRegionsTheLargerFirst) {
  const TriangleMesh body = bodies::blocks({16, 9, 8}, {1.2, 5, 5}, [](int x, int y, int z) {
    return (y >= 1 && y < 5) || (x == 8 && y >= 5) || (x == 8 && y == 0 && z < 4);
  });
  const ThinParts thin = skin_of(body).thin;
  ASSERT_EQ(thin.regions.size(), 2u);
  EXPECT_GT(thin.regions[0].volume_mm3, 5 * thin.regions[1].volume_mm3);
}

TEST(ThinParts, ABodyWithoutM1IsThinAltogetherAndSolid) {
  const Skin skin = skin_of(bodies::box(40, 40, 1.5));
  EXPECT_TRUE(skin.is_thin_everywhere());
  EXPECT_DOUBLE_EQ(skin.thin.fraction, 1.0);
  EXPECT_DOUBLE_EQ(skin.thin.volume_mm3, 40 * 40 * 1.5);
  EXPECT_DOUBLE_EQ(skin.volume_mm3, 40 * 40 * 1.5);
  EXPECT_FALSE(skin_of(bodies::box(40, 40, 3)).is_thin_everywhere());
}

TEST(ThinParts, ThreadsDoNotChangeThem) {
  RunContext one, four;
  one.threads = 1;
  four.threads = 4;
  const auto a = build_skin(block_with_fin(1), {.thickness_mm = 1.0}, one);
  const auto b = build_skin(block_with_fin(1), {.thickness_mm = 1.0}, four);
  EXPECT_GT(a->thin.volume_mm3, 0.0);
  EXPECT_EQ(a->thin.volume_mm3, b->thin.volume_mm3);
  EXPECT_EQ(a->thin.region_count, b->thin.region_count);
}

}  // namespace
}  // namespace skinframe
