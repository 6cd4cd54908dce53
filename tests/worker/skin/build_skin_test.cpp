// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/skin/build_skin.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/worker/skin/bodies.h"
#include "worker/skin/mend_edges.h"

namespace skinframe {
namespace {

constexpr double kPi = std::numbers::pi;

Skin skin_of(const TriangleMesh& body, SkinOptions options) {
  RunContext context;
  auto skin = build_skin(body, options, context);
  EXPECT_TRUE(skin.ok()) << skin.error().message;
  return std::move(skin.value());
}

double ball(double r) { return 4.0 / 3.0 * kPi * r * r * r; }

TEST(BuildSkin, HollowOfASphereIsASphereOneThicknessSmaller) {
  const TriangleMesh body = bodies::sphere(20.0);
  const Skin skin = skin_of(body, {.thickness_mm = 1.0});
  EXPECT_NEAR(skin.cavity_volume_mm3, ball(19.0), 0.003 * ball(19.0));
  EXPECT_NEAR(skin.volume_mm3, ball(20.0) - ball(19.0), 0.02 * (ball(20.0) - ball(19.0)));
  EXPECT_NEAR(skin.volume_mm3 + skin.cavity_volume_mm3, signed_volume(body), 0.003 * signed_volume(body));
  EXPECT_NEAR((skin.centroid_mm - Eigen::Vector3d(0, 0, 20)).norm(), 0.0, 0.02);
  EXPECT_EQ(count_bad_edges(skin.inner_surface), 0);
  EXPECT_EQ(bodies::euler_characteristic(skin.inner_surface), 2);
  for (const auto& p : skin.inner_surface.vertices) {
    ASSERT_NEAR((p - Eigen::Vector3d(0, 0, 20)).norm(), 19.0, 0.08);
  }
}

TEST(BuildSkin, HollowOfABoxIsABox) {
  const Skin skin = skin_of(bodies::box(60, 40, 30), {.thickness_mm = 1.0});
  const double hollow = 58.0 * 38.0 * 28.0;
  EXPECT_NEAR(skin.cavity_volume_mm3, hollow, 0.003 * hollow);
  EXPECT_NEAR(skin.volume_mm3, 60.0 * 40.0 * 30.0 - hollow, 0.01 * (60.0 * 40.0 * 30.0 - hollow));
  EXPECT_NEAR((skin.centroid_mm - Eigen::Vector3d(30, 20, 15)).norm(), 0.0, 0.02);
  EXPECT_NEAR(skin.plate_z_mm, 0.0, 1e-9);
}

// M1's walls at 1.2 and 46.2 mm run through points of both grids (0.3 and 0.6 mm).
TEST(BuildSkin, AWallThroughThePointsOfTheGridIsOneSheet) {
  TriangleMesh on_points = bodies::box(47, 47, 47), off_points = on_points;
  for (auto& v : on_points.vertices) v += Eigen::Vector3d::Constant(0.2);
  for (auto& v : off_points.vertices) v += Eigen::Vector3d::Constant(0.33);
  const Skin on = skin_of(on_points, {.thickness_mm = 1.0}), off = skin_of(off_points, {.thickness_mm = 1.0});
  // The grid cuts the twelve edges by up to a voxel; a second sheet would add as much as there is.
  EXPECT_NEAR(surface_area(on.inner_surface), 6 * 45.0 * 45.0, 0.03 * 6 * 45 * 45);
  EXPECT_LT(on.inner_surface.triangles.size(), 1.1 * off.inner_surface.triangles.size());
  EXPECT_NEAR(on.cavity_volume_mm3, 45.0 * 45.0 * 45.0, 0.002 * 45 * 45 * 45);
}

TEST(BuildSkin, HollowOfATorusKeepsItsHole) {
  const Skin skin = skin_of(bodies::torus(24, 9), {.thickness_mm = 0.8});
  const double hollow = 2.0 * kPi * kPi * 24.0 * 8.2 * 8.2;
  EXPECT_NEAR(skin.cavity_volume_mm3, hollow, 0.006 * hollow);  // 0.5 % of it is the facets of the body
  EXPECT_EQ(bodies::euler_characteristic(skin.inner_surface), 0);
}

TEST(BuildSkin, FinerVoxelsComeNearerToTheTruth) {
  const TriangleMesh body = bodies::sphere(10.0);
  const double truth = ball(9.0);
  const double coarse = skin_of(body, {.thickness_mm = 1.0, .voxel_mm = 0.8}).cavity_volume_mm3;
  const double fine = skin_of(body, {.thickness_mm = 1.0, .voxel_mm = 0.2}).cavity_volume_mm3;
  EXPECT_LT(std::abs(fine - truth), std::abs(coarse - truth));
}

TEST(BuildSkin, PlateThinnerThanTwoSkinsIsSolid) {
  const Skin skin = skin_of(bodies::box(40, 40, 1.8), {.thickness_mm = 1.0});
  EXPECT_TRUE(skin.inner_surface.triangles.empty());
  EXPECT_EQ(skin.cavity_volume_mm3, 0.0);
  EXPECT_NEAR(skin.volume_mm3, 40 * 40 * 1.8, 1e-3);
  EXPECT_NEAR((skin.centroid_mm - Eigen::Vector3d(20, 20, 0.9)).norm(), 0.0, 1e-3);
}

TEST(BuildSkin, SameAtAnyThreadCount) {
  const TriangleMesh body = bodies::torus(20, 6);
  RunContext one, two;
  two.threads = 2;
  const auto a = build_skin(body, {.thickness_mm = 1.0}, one),
             b = build_skin(body, {.thickness_mm = 1.0}, two);
  ASSERT_TRUE(a.ok() && b.ok());
  EXPECT_EQ(a->cavity_volume_mm3, b->cavity_volume_mm3);
  EXPECT_EQ(a->inner_surface.vertices, b->inner_surface.vertices);
  EXPECT_EQ(a->inner_surface.triangles, b->inner_surface.triangles);
}

TEST(BuildSkin, RefusesAGridThatWouldTakeTooMuchMemoryAndNamesTheRemedy) {
  RunContext context;
  const auto skin = build_skin(bodies::box(4000, 4000, 4000), {.thickness_mm = 1.0}, context);
  ASSERT_FALSE(skin.ok());
  EXPECT_EQ(skin.error().kind, ErrorKind::kInvalidInput);
  EXPECT_THAT(skin.error().message, testing::HasSubstr("--size"));
}

TEST(BuildSkin, RefusesOptionsOutOfRangeAndBodiesWithoutVolume) {
  RunContext context;
  const TriangleMesh body = bodies::box(10, 10, 10);
  EXPECT_EQ(build_skin(body, {.thickness_mm = 0.0}, context).error().kind, ErrorKind::kInvalidInput);
  EXPECT_EQ(build_skin(body, {.thickness_mm = 1.0, .voxel_mm = 1.5}, context).error().kind,
            ErrorKind::kInvalidInput);
  EXPECT_EQ(build_skin(TriangleMesh{}, {.thickness_mm = 1.0}, context).error().kind,
            ErrorKind::kInvalidInput);
  TriangleMesh inside_out = body;
  for (auto& t : inside_out.triangles) std::swap(t[0], t[1]);
  EXPECT_EQ(build_skin(inside_out, {.thickness_mm = 1.0}, context).error().kind, ErrorKind::kInvalidInput);
}

TEST(BuildSkin, StopsWhenTheJobIsCancelled) {
  std::stop_source source;
  source.request_stop();
  RunContext context;
  context.stop = source.get_token();
  EXPECT_EQ(build_skin(bodies::box(10, 10, 10), {.thickness_mm = 1.0}, context).error().kind,
            ErrorKind::kCancelled);
}

}  // namespace
}  // namespace skinframe
