// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/skin/distance_field.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "tests/worker/skin/bodies.h"
#include "worker/skin/build_skin.h"

namespace skinframe {
namespace {

class SphereField : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    RunContext context;
    auto skin = build_skin(bodies::sphere(20.0), {.thickness_mm = 1.0}, context);
    ASSERT_TRUE(skin.ok());
    field_ = new DistanceField(skin->field);
  }
  static void TearDownTestSuite() { delete field_; }
  static Eigen::Vector3d at_radius(double r) {
    return Eigen::Vector3d(0, 0, 20) + r * Eigen::Vector3d(0.36, 0.48, 0.8);
  }
  static DistanceField* field_;
};
DistanceField* SphereField::field_ = nullptr;

TEST_F(SphereField, IsTheDistanceFromJustOutsideToTheCentre) {
  for (double r = 1.5; r < 20.5; r += 0.37)
    EXPECT_NEAR(field_->at(at_radius(r)), r - 20.0, 0.06) << "radius " << r;
}

TEST_F(SphereField, SaysTheOuterBandFarAway) {
  EXPECT_EQ(field_->at(at_radius(25.0)), field_->outer_band_mm());
  EXPECT_EQ(field_->at({1e12, 0, 0}), field_->outer_band_mm());
  EXPECT_EQ(field_->at({std::numeric_limits<double>::quiet_NaN(), 0, 0}), field_->outer_band_mm());
}

TEST_F(SphereField, GradientPointsOutward) {
  for (double r : {3.0, 10.0, 18.0, 19.0, 20.0}) {
    EXPECT_NEAR(field_->gradient(at_radius(r)).dot(Eigen::Vector3d(0.36, 0.48, 0.8)), 1.0, 0.05)
        << "radius " << r;
  }
}

// A tenth of a millimetre wide, where a voxel has three: no point of the grid need be in it.
TEST(DistanceField, AVoidNarrowerThanAVoxelHasWallsAllTheSame) {
  TriangleMesh body = bodies::box(20, 20, 20);
  const TriangleMesh gap = bodies::box(10, 10, 0.1);
  const int first = static_cast<int>(body.vertices.size());
  for (const auto& v : gap.vertices) body.vertices.push_back(v + Eigen::Vector3d(5, 5, 10.02));
  for (const auto& [a, b, c] : gap.triangles) body.triangles.push_back({first + a, first + c, first + b});
  RunContext context;
  const auto skin = build_skin(body, {.thickness_mm = 1.0}, context);
  ASSERT_TRUE(skin.ok()) << skin.error().message;
  for (const double above : {0.2, 0.5, 0.9}) {
    EXPECT_NEAR(skin->field.at({10, 10, 10.12 + above}), -above, 0.15) << above;
    EXPECT_NEAR(skin->field.at({9, 11, 10.02 - above}), -above, 0.15) << above;
  }
  // Steiner: the gap, its sides, quarters of cylinders about its edges, a ball.
  const double walled = 10.0 + 204.0 + std::numbers::pi / 4 * 80.4 + 4.0 / 3.0 * std::numbers::pi;
  EXPECT_NEAR(skin->cavity_volume_mm3, 18.0 * 18.0 * 18.0 - walled, 40.0);
}

// Its sides are two triangles each, of which the grid sees all but the last two and a half millimetres.
TEST(DistanceField, AVoidThatEndsNarrowerThanAVoxelHasWallsToItsTip) {
  constexpr double kLength = 20.0, kHeight = 1.84, kTip = 0.01, kMiddle = 10.02, kBeforeTip = 1.3;
  TriangleMesh body = bodies::box(30, 20, 20);
  TriangleMesh wedge = bodies::box(kLength, 10, kHeight);
  for (auto& v : wedge.vertices) v.z() = (v.z() - kHeight / 2) * (v.x() > kLength / 2 ? kTip / kHeight : 1.0);
  const int first = static_cast<int>(body.vertices.size());
  for (const auto& v : wedge.vertices) body.vertices.push_back(v + Eigen::Vector3d(5, 5, kMiddle));
  for (const auto& [a, b, c] : wedge.triangles) body.triangles.push_back({first + a, first + c, first + b});
  RunContext context;
  const auto skin = build_skin(body, {.thickness_mm = 1.0}, context);
  ASSERT_TRUE(skin.ok()) << skin.error().message;
  const double half_height = 0.5 * (kTip + (kHeight - kTip) * kBeforeTip / kLength);
  for (const double y : {7.0, 10.0, 13.0}) {
    const double x = 5.0 + kLength - kBeforeTip;
    EXPECT_NEAR(skin->field.at({x, y, kMiddle + 0.5}), half_height - 0.5, 0.15) << y;
    EXPECT_NEAR(skin->field.at({x, y, kMiddle - 0.5}), half_height - 0.5, 0.15) << y;
  }
}

TEST(DistanceField, MadeOfNothingIsZeroEverywhere) {
  const DistanceField field;
  EXPECT_EQ(field.at({1, 2, 3}), 0.0);
  EXPECT_EQ(field.gradient({1, 2, 3}), Eigen::Vector3d(Eigen::Vector3d::Zero()));
}

}  // namespace
}  // namespace skinframe
