// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/drain/place_openings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/worker/drain/hollow.h"
#include "worker/frame/vertex_graph.h"

namespace skinframe {
namespace {

PlacedOpenings placed_on(const hollow::Body& body, const OpeningRule& rule,
                         const std::vector<KeepAway>& keep_away = {},
                         const std::vector<Opening>& refused = {}) {
  RunContext context;
  return place_openings(body.mesh, body.skin, contact_hull(body.mesh), nullptr, rule,
                        split_pieces(body.skin.inner_surface), keep_away, refused, context);
}

TEST(PlaceOpenings, ABoxHasTwoBelowFarApartAndWithinItsBase) {
  const hollow::Body box = hollow::make(bodies::box(90, 70, 60));
  const PlacedOpenings placed = placed_on(box, {20, 20, 2});
  EXPECT_THAT(placed.warnings, testing::IsEmpty());
  ASSERT_EQ(placed.openings.size(), 2u);
  for (const Opening& opening : placed.openings) {
    EXPECT_EQ(opening.radius_mm, 10);
    EXPECT_LT(opening.axis.z(), -0.999);
    EXPECT_NEAR(opening.centre_mm.z(), 0, 1e-6);
    const double rim = rim_radius_mm(opening, 1.0);
    EXPECT_GT(opening.centre_mm.x(), rim);
    EXPECT_LT(opening.centre_mm.x(), 90 - rim);
    EXPECT_GT(opening.centre_mm.y(), rim);
    EXPECT_LT(opening.centre_mm.y(), 70 - rim);
  }
  EXPECT_GT((placed.openings[0].centre_mm - placed.openings[1].centre_mm).norm(), 40.0);
}

TEST(PlaceOpenings, TheSameEveryTime) {
  const hollow::Body ball = hollow::make(bodies::sphere(24, 4));
  const PlacedOpenings one = placed_on(ball, {8, 8, 2}), two = placed_on(ball, {8, 8, 2});
  ASSERT_EQ(one.openings.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(one.openings[i].centre_mm, two.openings[i].centre_mm);
}

TEST(PlaceOpenings, ABallIsOpenedBelow) {
  const hollow::Body ball = hollow::make(bodies::sphere(24, 4));
  const PlacedOpenings placed = placed_on(ball, {10, 10, 1});
  ASSERT_EQ(placed.openings.size(), 1u);
  EXPECT_LT(placed.openings[0].axis.z(), -0.7);
}

TEST(PlaceOpenings, StaysAwayFromWhatIsLoaded) {
  const hollow::Body box = hollow::make(bodies::box(90, 70, 60));
  const Eigen::Vector3d loaded(20, 20, 0);
  for (const Opening& opening : placed_on(box, {20, 20, 2}, {{loaded, 12}}).openings)
    EXPECT_GE((opening.centre_mm - loaded).norm(), 22.0);
}

TEST(PlaceOpenings, ABodyTooSmallForTheRuleSaysSoWithARemedy) {
  const hollow::Body box = hollow::make(bodies::box(24, 24, 24));
  const PlacedOpenings placed = placed_on(box, {20, 20, 2});
  EXPECT_THAT(placed.openings, testing::IsEmpty());
  ASSERT_EQ(placed.warnings.size(), 1u);
  EXPECT_THAT(placed.warnings[0], testing::HasSubstr("cannot be emptied: it has 0 of 2 drain holes"));
  EXPECT_THAT(placed.warnings[0], testing::HasSubstr("--size"));
}

TEST(PlaceOpenings, TakesASmallerHoleWhereTheRuleAllowsIt) {
  const hollow::Body box = hollow::make(bodies::box(24, 24, 24));
  const PlacedOpenings placed = placed_on(box, {20, 5, 2});
  ASSERT_EQ(placed.openings.size(), 2u);
  for (const Opening& opening : placed.openings) {
    EXPECT_LT(opening.radius_mm, 10);
    EXPECT_GE(opening.radius_mm, 2.5);
  }
  EXPECT_THAT(placed.warnings, testing::SizeIs(2));
  EXPECT_THAT(placed.warnings, testing::Each(testing::HasSubstr("mm wide, not 20")));
}

TEST(PlaceOpenings, WhatWasRefusedIsPlacedElsewhereOrSmaller) {
  const hollow::Body box = hollow::make(bodies::box(90, 70, 60));
  const auto first = placed_on(box, {20, 20, 2}).openings;
  ASSERT_EQ(first.size(), 2u);
  const PlacedOpenings again = placed_on(box, {20, 20, 2}, {}, first);
  ASSERT_EQ(again.openings.size(), 2u);
  for (const Opening& opening : again.openings)
    for (const Opening& other : first)
      EXPECT_GE((opening.centre_mm - other.centre_mm).norm(), kRefusedInRadii * other.radius_mm);

  // Of that width refused all over the cube.
  const hollow::Body cube = hollow::make(bodies::box(24, 24, 24));
  std::vector<Opening> all;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {0.0, 24.0})
      for (double u = 0; u <= 24; u += 1.5)
        for (double v = 0; v <= 24; v += 1.5) {
          Opening opening{{}, {}, 3, 1, 2};
          opening.centre_mm[axis] = side;
          opening.centre_mm[(axis + 1) % 3] = u;
          opening.centre_mm[(axis + 2) % 3] = v;
          all.push_back(opening);
        }
  EXPECT_EQ(placed_on(cube, {6, 6, 1}).openings.size(), 1u);
  EXPECT_THAT(placed_on(cube, {6, 6, 1}, {}, all).openings, testing::IsEmpty());
  const auto smaller = placed_on(cube, {6, 4, 1}, {}, all).openings;
  ASSERT_EQ(smaller.size(), 1u);
  EXPECT_LT(smaller[0].radius_mm, 3.0);
}

TEST(PlaceOpenings, EveryCavityHasOneOfItsOwn) {
  // Two cubes of 40 mm beside each other.
  const hollow::Body pair =
      hollow::make(bodies::blocks({3, 1, 1}, {40, 40, 40}, [](int x, int, int) { return x != 1; }));
  const PlacedOpenings placed = placed_on(pair, {12, 12, 2});
  EXPECT_THAT(placed.warnings, testing::IsEmpty());
  ASSERT_EQ(placed.openings.size(), 3u);
  int left = 0;
  for (const Opening& opening : placed.openings) left += opening.centre_mm.x() < 60;
  EXPECT_GE(left, 1);
  EXPECT_LE(left, 2);
}

}  // namespace
}  // namespace skinframe
