// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/solid/unite.h"

#include <gmock/gmock.h>

#include "tests/worker/solid/shapes.h"
#include "worker/solid/repair.h"

namespace skinframe {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using namespace testing;

RepairOutcome mend(const TriangleMesh& mesh) {
  RunContext context;
  auto outcome = repair(mesh, {}, context);
  EXPECT_TRUE(outcome.ok()) << outcome.error().message;
  return std::move(outcome).value();
}

Union unite(const TriangleMesh& mesh, bool exact) {
  RunContext context;
  auto united = unite_overlaps(mesh, {.max_self_overlap_relative = 0.01, .exact = exact}, context);
  EXPECT_TRUE(united.ok());
  return std::move(united).value();
}

// Of the body that circles of radius r with their middles at R < r from the axis sweep: the area at height z
// is a disc where the circle reaches over the axis, else a ring.
double swept_volume(double ring, double tube) {
  constexpr int kSlices = 200'000;
  double volume = 0;
  for (int i = 0; i < kSlices; ++i) {
    const double z = -tube + 2 * tube * (i + 0.5) / kSlices;
    const double half = std::sqrt(tube * tube - z * z);
    const double hole = std::max(0.0, ring - half);
    volume += std::numbers::pi * ((ring + half) * (ring + half) - hole * hole) * 2 * tube / kSlices;
  }
  return volume;
}

TEST(Unite, BodiesThatDoNotMeetAreLeftAlone) {
  const Union united = unite(merged(cube(20), moved(cube(20), {21, 0, 0})), true);
  EXPECT_FALSE(united.changed);
  EXPECT_THAT(united.repairs, IsEmpty());
}

TEST(Unite, SidesThatLieOnEachOtherVanish) {
  // A plinth with a block on it, sides flush on one edge: faces overlap without being equal.
  const auto outcome = mend(merged(box({0, 0, 0}, {40, 40, 10}), box({0, 10, 10}, {20, 30, 30})));
  EXPECT_NEAR(outcome.solid.volume_mm3(), 40 * 40 * 10 + 20 * 20 * 20, 0.1);
  EXPECT_NEAR(outcome.solid.area_mm2(), 2 * 1600 + 4 * 400 + 4 * 400, 0.1);
  EXPECT_THAT(outcome.warnings, IsEmpty());
}

TEST(Unite, ARowOfBodiesBecomesOne) {
  TriangleMesh row = cube(20);
  for (int i = 1; i < 30; ++i) row = merged(row, moved(cube(20), {13.0 * i, 0.37 * i, 0.21 * i}));
  const auto outcome = mend(row);
  const double shared = 7 * (20 - 0.37) * (20 - 0.21);
  EXPECT_NEAR(outcome.solid.volume_mm3() / (30 * 8000 - 29 * shared), 1, 1e-5);
  EXPECT_THAT(outcome.repairs, ElementsAre(HasSubstr("united 30 shells")));
}

TEST(Unite, ABarThroughACavityFillsItsPartOfIt) {
  // A hollow box of 30 with walls of 5, and a bar of 4 x 4 from one wall through the other and out.
  TriangleMesh hollow = merged(cube(30), turned_inside_out(box({5, 5, 5}, {25, 25, 25})));
  const auto outcome = mend(merged(hollow, box({2, 13, 13}, {40, 17, 17})));
  EXPECT_NEAR(outcome.solid.volume_mm3(), 27000 - 8000 + 16 * (20 + 10), 0.1);
  const double level_set = signed_volume(unite(merged(hollow, box({2, 13, 13}, {40, 17, 17})), false).mesh);
  EXPECT_NEAR(level_set / (27000 - 8000 + 16 * 30), 1, 0.005);
}

TEST(Unite, LevelSetsAgreeWithTheExactUnion) {
  const TriangleMesh balls = merged(ball(30, 60, 30), moved(ball(20, 60, 30), {25, 3, 2}));
  const double exact = signed_volume(unite(balls, true).mesh);
  const Union by_level_set = unite(balls, false);
  EXPECT_NEAR(signed_volume(by_level_set.mesh) / exact, 1, 0.002);
  EXPECT_THAT(by_level_set.repairs, ElementsAre(HasSubstr("in a level set of")));
}

TEST(Unite, HundredsOfBodiesInALevelSetAreOne) {
  // Too many for the exact union: one bar, and 300 through it.
  TriangleMesh bars = box({0, 0, 0}, {1200, 10, 10});
  for (int i = 0; i < 300; ++i) bars = merged(bars, box({4.0 * i, -5, 2}, {4.0 * i + 2, 15, 8}));
  const Union united = unite(bars, true);
  ASSERT_TRUE(united.changed);
  EXPECT_NEAR(signed_volume(united.mesh) / (1200 * 100 + 300 * 2 * 6 * 10), 1, 0.01);
  EXPECT_THAT(united.repairs, ElementsAre(HasSubstr("united 301 shells")));
}

TEST(Unite, ASurfaceThatRunsThroughItselfIsUnitedWithItself) {
  const TriangleMesh spindle = torus(10, 15, 120, 60);
  ASSERT_GT(std::abs(signed_volume(spindle) / swept_volume(10, 15) - 1), 0.01);  // its core counts wrongly
  const auto outcome = mend(spindle);
  EXPECT_THAT(outcome.repairs, ElementsAre(HasSubstr("united a surface with itself")));
  EXPECT_NEAR(outcome.solid.volume_mm3() / swept_volume(10, 15), 1, 0.01);
}

TEST(Unite, ASlightSelfCrossingIsAcceptedWithWhatItChanges) {
  // A ball with one corner tucked under the skin beside it, where another corner is pushed in.
  TriangleMesh mesh = ball(50, 80, 40);
  mesh.vertices[1500] = 0.98 * mesh.vertices[1503];
  mesh.vertices[1503] *= 0.95;
  const auto outcome = mend(mesh);
  EXPECT_THAT(outcome.repairs, IsEmpty());
  ASSERT_THAT(outcome.warnings, ElementsAre(HasSubstr("cut each other; accepted as it is")));
  EXPECT_EQ(outcome.solid.mesh().triangles.size(), mesh.triangles.size());
}

TEST(Unite, CancellationIsObeyed) {
  std::stop_source stop;
  stop.request_stop();
  RunContext context;
  context.stop = stop.get_token();
  const auto united = unite_overlaps(merged(cube(20), moved(cube(20), {10, 9, 8})), {}, context);
  ASSERT_FALSE(united.ok());
  EXPECT_EQ(united.error().kind, ErrorKind::kCancelled);
}

}  // namespace
}  // namespace skinframe
