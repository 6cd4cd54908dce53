// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/solid/repair.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "tests/worker/solid/shapes.h"

namespace skinframe {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using namespace testing;

Result<RepairOutcome> mend(TriangleMesh mesh) {
  RunContext context;
  return repair(std::move(mesh), {}, context);
}

std::string refusal_of(TriangleMesh mesh) {
  const Result<RepairOutcome> outcome = mend(std::move(mesh));
  if (outcome.ok()) return "no error";
  EXPECT_EQ(outcome.error().kind, ErrorKind::kInvalidInput);
  return outcome.error().message;
}

TEST(Repair, AFineMeshIsLeftAsItIs) {
  for (const TriangleMesh& mesh : {cube(20), ball(50, 40, 20), torus(40, 12, 30, 14)}) {
    const auto outcome = mend(mesh);
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_THAT(outcome->repairs, IsEmpty());
    EXPECT_THAT(outcome->warnings, IsEmpty());
    EXPECT_EQ(outcome->solid.mesh().triangles, mesh.triangles);
    EXPECT_NEAR(outcome->solid.volume_mm3() / signed_volume(mesh), 1, 1e-6);
  }
}

TEST(Repair, RepairingTwiceChangesNothing) {
  const auto once = mend(soup(torus(40, 12, 30, 14), 2e-3));
  ASSERT_TRUE(once.ok()) << once.error().message;
  const auto twice = mend(once->solid.mesh());
  ASSERT_TRUE(twice.ok()) << twice.error().message;
  EXPECT_THAT(twice->repairs, IsEmpty());
  EXPECT_EQ(twice->solid.mesh().triangles, once->solid.mesh().triangles);
}

TEST(Repair, TurnedTrianglesAreTurnedBack) {
  TriangleMesh mesh = ball(50, 40, 20);
  for (std::size_t t = 0; t < mesh.triangles.size(); t += 5)
    std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  const auto outcome = mend(mesh);
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  EXPECT_THAT(outcome->repairs, ElementsAre("turned 304 triangles round"));
  EXPECT_NEAR(outcome->solid.volume_mm3(), signed_volume(ball(50, 40, 20)), 0.1);
}

TEST(Repair, ABodyInsideOutIsTurnedOut) {
  const auto outcome = mend(turned_inside_out(cube(20)));
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  EXPECT_NEAR(outcome->solid.volume_mm3(), 8000, 1e-9);
  EXPECT_THAT(outcome->repairs, ElementsAre("turned 1 shell inside out"));
}

TEST(Repair, JitterOfMicrometresIsWelded) {
  const TriangleMesh whole = torus(70, 25, 40, 20);
  for (const double jitter : {0.0, 2e-5, 2e-4, 2e-3}) {
    const auto outcome = mend(soup(whole, jitter));
    ASSERT_TRUE(outcome.ok()) << outcome.error().message;
    EXPECT_EQ(outcome->solid.mesh().vertices.size(), whole.vertices.size());
    EXPECT_THAT(outcome->repairs, ElementsAre(HasSubstr("joined 4000 vertices")));
    EXPECT_NEAR(outcome->solid.volume_mm3() / signed_volume(whole), 1, 1e-4);
  }
}

TEST(Repair, RepeatedAndCollapsedTrianglesAreDropped) {
  TriangleMesh mesh = cube(20);
  mesh.triangles.push_back(mesh.triangles[3]);
  mesh.triangles.push_back({mesh.triangles[5][0], mesh.triangles[5][2], mesh.triangles[5][1]});
  mesh.triangles.push_back({1, 1, 2});
  const auto outcome = mend(mesh);
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  EXPECT_NEAR(outcome->solid.volume_mm3(), 8000, 1e-9);
  EXPECT_THAT(outcome->repairs, ElementsAre("dropped 1 collapsed triangle", "dropped 2 repeated triangles"));
}

TEST(Repair, AnInnerWallDrawnDoubleIsTakenOut) {
  // Two boxes that share a side: the wall between them bounds no material.
  const auto outcome = mend(merged(box({0, 0, 0}, {10, 10, 10}), box({10, 0, 0}, {20, 10, 10})));
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  EXPECT_NEAR(outcome->solid.volume_mm3(), 2000, 1e-9);
  EXPECT_THAT(outcome->repairs, Contains(HasSubstr("2 triangles of inner walls")));
}

TEST(Repair, BodiesThatTouchAlongAnEdgeStepApart) {
  const auto outcome = mend(merged(box({0, 0, 0}, {10, 10, 10}), box({10, 10, 0}, {20, 20, 10})));
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  EXPECT_NEAR(outcome->solid.volume_mm3(), 2000, 0.01);
  EXPECT_EQ(outcome->solid.mesh().vertices.size(), 16u);
  EXPECT_THAT(outcome->repairs, Contains(HasSubstr("touch along 1 edge")));
}

TEST(Repair, ConesThatTouchAtTheirTipsShareAVertex) {
  TriangleMesh mesh = merged(box({0, 0, 0}, {10, 10, 10}), box({10, 10, 10}, {20, 20, 20}));
  const auto outcome = mend(mesh);
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  EXPECT_EQ(outcome->solid.mesh().vertices.size(), 15u);
  EXPECT_NEAR(outcome->solid.volume_mm3(), 2000, 1e-9);
}

TEST(Repair, ASmallHoleIsFilledAndToldOf) {
  TriangleMesh mesh = ball(50, 80, 40);
  mesh.triangles.erase(mesh.triangles.begin() + 200, mesh.triangles.begin() + 203);
  mesh.triangles.erase(mesh.triangles.begin() + 900);
  const auto outcome = mend(mesh);
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  EXPECT_THAT(outcome->repairs, ElementsAre(HasSubstr("filled 3 holes of 10 edges")));
  EXPECT_NEAR(outcome->solid.volume_mm3() / signed_volume(ball(50, 80, 40)), 1, 1e-3);
}

TEST(Repair, ALargeOpeningIsRefusedWithItsPlaceAndLength) {
  TriangleMesh lidless = cube(20);
  lidless.triangles.erase(lidless.triangles.begin() + 2, lidless.triangles.begin() + 4);  // the side z = 20
  EXPECT_THAT(refusal_of(lidless), AllOf(HasSubstr("1 opening, 4 boundary edges"), HasSubstr("80 mm around"),
                                         HasSubstr("near (10, 10, 20)")));
}

TEST(Repair, TheLimitOfAHoleIsAnOption) {
  TriangleMesh mesh = ball(50, 80, 40);
  mesh.triangles.erase(mesh.triangles.begin() + 200);
  RepairOptions options;
  RunContext context;
  EXPECT_TRUE(repair(mesh, options, context).ok());
  options.max_hole_relative = options.max_flat_cut_relative = 0.01;
  EXPECT_FALSE(repair(mesh, options, context).ok());
}

TEST(Repair, OptionsOutOfRangeAreRefusedByName) {
  RepairOptions hole, weld, debris;
  hole.max_hole_relative = 1.1;
  weld.weld_tolerance_relative = -1;
  debris.max_debris_relative = std::numeric_limits<double>::quiet_NaN();
  RunContext context;
  EXPECT_THAT(repair(cube(20), hole, context).error().message,
              HasSubstr("max_hole_relative must be in [0, 1]"));
  EXPECT_THAT(repair(cube(20), weld, context).error().message, HasSubstr("weld_tolerance_relative"));
  EXPECT_THAT(repair(cube(20), debris, context).error().message, HasSubstr("max_debris_relative"));
}

TEST(Repair, ScrapsAreDroppedNotFilled) {
  TriangleMesh mesh = cube(20);
  mesh = merged(mesh, {{{5, 5, 25}, {5.01, 5, 25}, {5, 5.01, 25}}, {{0, 1, 2}}});
  const auto outcome = mend(mesh);
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  EXPECT_THAT(outcome->repairs, ElementsAre("dropped 1 loose scrap"));
  EXPECT_EQ(outcome->solid.mesh().vertices.size(), 8u);
}

TEST(Repair, AShellThatLooksInwardIsACavity) {
  const auto outcome = mend(merged(cube(20), turned_inside_out(box({5, 5, 5}, {15, 15, 15}))));
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  EXPECT_NEAR(outcome->solid.volume_mm3(), 7000, 1e-9);
  const auto both_turned =
      mend(turned_inside_out(merged(cube(20), turned_inside_out(box({5, 5, 5}, {15, 15, 15})))));
  ASSERT_TRUE(both_turned.ok()) << both_turned.error().message;
  EXPECT_NEAR(both_turned->solid.volume_mm3(), 7000, 1e-9);
}

TEST(Repair, AShellWithinMaterialThatLooksOutwardIsSwallowed) {
  const auto outcome = mend(merged(cube(20), box({5, 5, 5}, {15, 15, 15})));
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  EXPECT_NEAR(outcome->solid.volume_mm3(), 8000, 1e-9);
  EXPECT_THAT(outcome->repairs, ElementsAre("dropped 1 shell within the material of another"));
}

TEST(Repair, BodiesThatOverlapBecomeOne) {
  const auto outcome = mend(merged(cube(20), moved(cube(20), {10, 9, 8})));
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  EXPECT_NEAR(outcome->solid.volume_mm3(), 2 * 8000 - 10 * 11 * 12, 0.05);
  EXPECT_THAT(
      outcome->repairs,
      ElementsAre("united 2 shells that overlap: their volumes add up to 16000 mm3 and enclose 14680 mm3"));
  EXPECT_THAT(outcome->warnings, IsEmpty());
}

TEST(Repair, AFlatCutThroughTheWholeBodyIsCappedAndToldOf) {
  TriangleMesh bust = ball(50, 80, 40);  // its last three rings cut away: open where a plane cut it off
  const double plane = -50 * std::cos(3 * std::numbers::pi / 40);
  std::erase_if(bust.triangles, [&](const auto& t) {
    return bust.vertices[t[0]].z() + bust.vertices[t[1]].z() + bust.vertices[t[2]].z() < 3 * plane - 1e-6;
  });
  const auto outcome = mend(bust);
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  EXPECT_THAT(outcome->repairs, Contains(HasSubstr("capped the flat cut of 80 edges")));
  const double height = 50 + plane;  // of the cap that is missing
  const double missing = std::numbers::pi * height * height * (50 - height / 3);
  EXPECT_NEAR(outcome->solid.volume_mm3() / (signed_volume(ball(50, 80, 40)) - missing), 1, 1e-3);
  EXPECT_NEAR(outcome->solid.box().min.z(), plane, 1e-4);
}

TEST(Repair, AnEdgeThatLiesAlongTwoShortOnesIsNoHole) {
  TriangleMesh mesh = cube(20);
  // The side y = 20 gets the middle of its lower edge; its neighbour z = 0 does not know of it.
  const int middle = static_cast<int>(mesh.vertices.size());
  mesh.vertices.emplace_back(10, 20, 0);
  std::erase(mesh.triangles, std::array<int, 3>{2, 6, 3});
  mesh.triangles.push_back({2, 6, middle});
  mesh.triangles.push_back({middle, 6, 3});
  const auto outcome = mend(mesh);
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  EXPECT_THAT(outcome->repairs, ElementsAre("joined 1 vertex to the edges that they lie on"));
  EXPECT_NEAR(outcome->solid.volume_mm3(), 8000, 0.01);
}

TEST(Repair, WhatCannotBeMendedIsWrappedAndToldOf) {
  // Two small fins at one edge: four triangles there, and no two of them have material between them.
  const TriangleMesh whole = ball(60, 60, 30);
  TriangleMesh mesh = whole;
  const auto t = mesh.triangles[1000];
  const Eigen::Vector3d out = mesh.vertices[t[0]].normalized();
  for (const double height : {1.0, 1.5}) {
    mesh.triangles.push_back({t[0], t[1], static_cast<int>(mesh.vertices.size())});
    mesh.vertices.push_back(mesh.vertices[t[0]] + height * out + Eigen::Vector3d(0, 0, 2 - height));
  }
  const auto outcome = mend(mesh);
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  ASSERT_THAT(outcome->repairs, Contains(AllOf(HasSubstr("as a last resort, since the edge from"),
                                               HasSubstr("shared by 4 triangles"), HasSubstr("wrapped"))));
  EXPECT_NEAR(outcome->solid.volume_mm3() / signed_volume(whole), 1, 0.02);
  RepairOptions never;
  never.max_wrap_volume_change_relative = 0;
  RunContext context;
  const auto refused = repair(mesh, never, context);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message, HasSubstr("shared by 4 triangles that bound no material"));
  never.max_wrap_volume_change_relative = 1e-4;
  const auto too_much = repair(mesh, never, context);
  ASSERT_FALSE(too_much.ok());
  EXPECT_THAT(too_much.error().message,
              AllOf(HasSubstr("shared by 4"), HasSubstr("more than 0.01 % of change")));
}

TEST(Repair, AWrapHidesNoLargeOpening) {
  TriangleMesh mesh = cube(20);
  for (const double height : {25.0, 30.0}) {
    mesh.triangles.push_back({1, 2, static_cast<int>(mesh.vertices.size())});
    mesh.vertices.emplace_back(height, height, height);
  }
  EXPECT_THAT(refusal_of(mesh),
              AllOf(HasSubstr("shared by 4 triangles"), HasSubstr("too large to be closed")));
}

TEST(Repair, AMoebiusStripIsRefusedByName) {
  EXPECT_THAT(refusal_of(moebius_strip(40)), HasSubstr("Moebius"));
}

TEST(Repair, SheetsEncloseNothing) {
  const TriangleMesh plane{{{0, 0, 0}, {20, 0, 0}, {20, 20, 0}, {0, 20, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  EXPECT_THAT(refusal_of(plane), HasSubstr("the surface is open"));
  EXPECT_THAT(refusal_of(merged(plane, turned_inside_out(plane))), HasSubstr("the surface is open"));
}

TEST(Repair, AFinIsDroppedAndToldOf) {
  TriangleMesh mesh = cube(20);
  const int tip = static_cast<int>(mesh.vertices.size());
  mesh.vertices.emplace_back(30, 30, 30);
  mesh.triangles.push_back({1, 2, tip});
  const auto outcome = mend(mesh);
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  EXPECT_THAT(outcome->repairs,
              ElementsAre("dropped 1 triangle of a fin without thickness that stood out of the body"));
  EXPECT_EQ(outcome->solid.mesh().triangles, cube(20).triangles);
}

TEST(Repair, AnInnerWallDrawnOnceIsTakenOut) {
  // A box of two chambers: the wall at x = 10 meets the four sides in edges of three triangles.
  TriangleMesh mesh = merged(box({0, 0, 0}, {10, 20, 20}), box({10, 0, 0}, {25, 20, 20}));
  std::erase_if(mesh.triangles, [&](const auto& t) {  // the second box leaves its own side there out
    return t[0] >= 8 && mesh.vertices[t[0]].x() == 10 && mesh.vertices[t[1]].x() == 10 &&
           mesh.vertices[t[2]].x() == 10;
  });
  const auto outcome = mend(mesh);
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  EXPECT_THAT(outcome->repairs, Contains("dropped 2 triangles of walls without thickness within the body"));
  EXPECT_NEAR(outcome->solid.volume_mm3(), 25 * 20 * 20, 0.01);
}

TEST(Repair, EmptyCollapsedAndBrokenMeshesAreRefused) {
  EXPECT_THAT(refusal_of({}), HasSubstr("no triangle"));
  EXPECT_THAT(refusal_of({{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {{0, 1, 2}}}), HasSubstr("no extent"));
  EXPECT_THAT(refusal_of({{{0, 0, 0}, {1, 0, 0}}, {{0, 1, 2}}}), HasSubstr("triangle 0: index 2 of 2"));
  TriangleMesh nan = cube(20);
  nan.vertices[6].z() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal_of(nan), HasSubstr("vertex 6"));
}

// The prototype's torture: a third of the triangles turned, 200 repeated, every corner off by 2 micrometres.
TEST(Repair, EverythingAtOnceIsMended) {
  const TriangleMesh whole = ball(60, 100, 50);
  TriangleMesh mesh = whole;
  std::mt19937 random(3);
  mesh.triangles.erase(mesh.triangles.begin() + 4000);
  for (auto& t : mesh.triangles) {
    if (random() % 3 == 0) std::swap(t[1], t[2]);
  }
  for (int i = 0; i < 200; ++i) mesh.triangles.push_back(mesh.triangles[random() % mesh.triangles.size()]);
  const auto outcome = mend(soup(mesh, 2e-3));
  ASSERT_TRUE(outcome.ok()) << outcome.error().message;
  EXPECT_NEAR(outcome->solid.volume_mm3() / signed_volume(whole), 1, 1e-3);
  EXPECT_EQ(outcome->repairs.size(), 4u);
}

TEST(Repair, MoreShellsThanCanBeComparedAreRefused) {
  TriangleMesh dust;
  for (int i = 0; i < 10'001; ++i)
    dust = merged(std::move(dust), moved(cube(1), {2.0 * (i % 100), 2.0 * (i / 100), 0}));
  EXPECT_THAT(refusal_of(dust), HasSubstr("10001 unconnected shells"));
}

TEST(Repair, ALongOpeningIsRefusedInTime) {
  TriangleMesh tube;  // 50,000 quads around, open at both ends
  constexpr int kAround = 50'000;
  for (int i = 0; i < kAround; ++i) {
    const double angle = 2 * std::numbers::pi * i / kAround;
    for (const double z : {0.0, 50.0})
      tube.vertices.emplace_back(1e4 * std::cos(angle), 1e4 * std::sin(angle), z);
  }
  for (int i = 0; i < kAround; ++i) {
    const int a = 2 * i, b = 2 * ((i + 1) % kAround);
    tube.triangles.push_back({a, b, b + 1});
    tube.triangles.push_back({a, b + 1, a + 1});
  }
  EXPECT_THAT(refusal_of(tube), HasSubstr("2 openings, 100000 boundary edges"));
}

TEST(Repair, CancellationIsObeyed) {
  std::stop_source stop;
  stop.request_stop();
  RunContext context;
  context.stop = stop.get_token();
  const auto outcome = repair(cube(20), {}, context);
  ASSERT_FALSE(outcome.ok());
  EXPECT_EQ(outcome.error().kind, ErrorKind::kCancelled);
}

}  // namespace
}  // namespace skinframe
