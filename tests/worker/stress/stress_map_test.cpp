// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/stress/stress_map.h"

#include <gtest/gtest.h>

#include "tests/worker/skin/bodies.h"

namespace skinframe {
namespace {

constexpr double kHeight = 60;

Skin skin_of(const TriangleMesh& body) {
  RunContext context;
  auto skin = build_skin(body, {.thickness_mm = 1.0}, context);
  EXPECT_TRUE(skin.ok()) << skin.error().message;
  return std::move(skin.value());
}

StressOptions light_pa() {
  StressOptions options;
  options.material.modulus_mpa = 1586;
  options.density_g_cm3 = 1e-6;  // loads alone
  options.tetrahedra = 12000;
  return options;
}

StressMap map_of(const Skin& skin, const std::vector<StressLoad>& loads, const StressOptions& options) {
  RunContext context;
  auto map = map_stress(skin, loads, options, context);
  EXPECT_TRUE(map.ok()) << map.error().message;
  return std::move(map.value());
}

StressLoad on_top(const std::string& name, const Eigen::Vector3d& force_n) {
  return {name, {10, 10, kHeight}, force_n, 12};
}

TEST(StressMap, PressedColumnCarriesForceOverArea) {
  const Skin skin = skin_of(bodies::box(20, 20, kHeight));
  const StressMap map = map_of(skin, {on_top("press", {0, 0, -100})}, light_pa());
  const double expected = 100.0 / (18.0 * 18.0);  // M1 is 18 mm wide
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(10, 10, 30), {1, 10, 30}, {19, 10, 25}, {10, 10, 22}})
    EXPECT_NEAR(map.von_mises_mpa_at(p).value(), expected, 0.06 * expected) << p.transpose();
  EXPECT_NEAR(map.covered_volume_share(), 1.0, 0.03);
  EXPECT_FALSE(map.uses_whole_body());
}

TEST(StressMap, PushedColumnIsStressedAsABeam) {
  const Skin skin = skin_of(bodies::box(20, 20, kHeight));
  const StressMap map = map_of(skin, {on_top("push", {10, 0, 0})}, light_pa());
  const double inertia = 18.0 * 18.0 * 18.0 * 18.0 / 12.0;
  for (const double z : {20.0, 30.0, 40.0}) {
    const double expected = 10.0 * (kHeight - 1.0 - z) * 9.0 / inertia;
    // At the face the stress is largest; averaging over tetrahedra blunts it.
    EXPECT_NEAR(map.von_mises_mpa_at({1, 10, z}).value(), expected, 0.2 * expected) << z;
    EXPECT_LT(map.von_mises_mpa_at({10, 10, z}).value(), 0.5 * expected) << z;
  }
}

TEST(StressMap, WorstLoadCaseCountsAndLoadsOfOneNameActTogether) {
  const Skin skin = skin_of(bodies::box(20, 20, kHeight));
  const Eigen::Vector3d face(1, 10, 30);
  const double push = map_of(skin, {on_top("x", {10, 0, 0})}, light_pa()).von_mises_mpa_at(face).value();
  const double both = map_of(skin, {on_top("x", {10, 0, 0}), on_top("y", {0, 10, 0})}, light_pa())
                          .von_mises_mpa_at(face)
                          .value();
  const double cancelled = map_of(skin, {on_top("x", {10, 0, 0}), on_top("x", {-10, 0, 0})}, light_pa())
                               .von_mises_mpa_at(face)
                               .value();
  EXPECT_NEAR(both, push, 0.02 * push);
  EXPECT_LT(cancelled, 1e-3 * push);
}

TEST(StressMap, SelfWeightGrowsTowardsTheBase) {
  const Skin skin = skin_of(bodies::box(20, 20, kHeight));
  StressOptions options = light_pa();
  options.density_g_cm3 = 1.15;
  const StressMap map = map_of(skin, {}, options);
  for (const double z : {20.0, 40.0}) {
    const double expected = 1.15e-9 * 9810.0 * (kHeight - 1.0 - z);
    EXPECT_NEAR(map.von_mises_mpa_at({10, 10, z}).value(), expected, 0.1 * expected) << z;
  }
}

TEST(StressMap, IsPositiveOnTheSurfaceAndNothingFarAway) {
  const Skin skin = skin_of(bodies::torus(26, 10));
  StressOptions options = light_pa();
  options.density_g_cm3 = 1.15;
  const StressMap map = map_of(skin, {}, options);
  for (const auto& v : skin.inner_surface.vertices) {
    const auto stress = map.von_mises_mpa_at(v);
    ASSERT_TRUE(stress.has_value());
    EXPECT_GT(*stress, 0.0);
  }
  EXPECT_FALSE(map.von_mises_mpa_at({500, 0, 0}).has_value());
  EXPECT_FALSE(map.von_mises_mpa_at({1e300, 0, 0}).has_value());
  EXPECT_FALSE(StressMap().von_mises_mpa_at({0, 0, 0}).has_value());
}

// Two blocks one above the other with a neck of 1.8 mm, which is thinner than two skins.
TEST(StressMap, PartOfM1ThatHangsOnASolidNeckIsMappedOnTheWholeBody) {
  const TriangleMesh body = bodies::blocks({9, 9, 20}, {1.8, 1.8, 1.8}, [](int x, int y, int z) {
    return (z != 9 && z != 10) || (x == 4 && y >= 1 && y < 8);
  });
  const Skin skin = skin_of(body);
  StressOptions options = light_pa();
  options.tetrahedra = 40000;
  const StressMap map = map_of(skin, {{"push", {8, 8, 36}, {0, 1, 0}, 5}}, options);
  EXPECT_TRUE(map.uses_whole_body());
  EXPECT_GT(map.von_mises_mpa_at({8, 8, 30}).value_or(0.0), 0.0);
}

TEST(StressMap, SameAtAnyThreadCount) {
  const Skin skin = skin_of(bodies::sphere(14));
  RunContext one, two;
  two.threads = 2;
  const auto a = map_stress(skin, {}, light_pa(), one), b = map_stress(skin, {}, light_pa(), two);
  ASSERT_TRUE(a.ok() && b.ok());
  for (const auto& v : skin.inner_surface.vertices) ASSERT_EQ(a->von_mises_mpa_at(v), b->von_mises_mpa_at(v));
}

TEST(StressMap, BodyThinnerThanTwoSkinsIsRefusedAndCancellationHeard) {
  RunContext context;
  const Skin plate = skin_of(bodies::box(40, 40, 1.8));
  const auto refused = map_stress(plate, {}, light_pa(), context);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().kind, ErrorKind::kInvalidInput);
  std::stop_source stop;
  stop.request_stop();
  context.stop = stop.get_token();
  const auto stopped = map_stress(skin_of(bodies::sphere(10)), {}, light_pa(), context);
  ASSERT_FALSE(stopped.ok());
  EXPECT_EQ(stopped.error().kind, ErrorKind::kCancelled);
}

}  // namespace
}  // namespace skinframe
