// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/profile/printable_length.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace skinframe {
namespace {

using Points = std::vector<PrintableLength::Point>;

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

PrintableLength curve(Points points) {
  auto made = PrintableLength::make(std::move(points), true, "a test");
  EXPECT_TRUE(made.ok()) << made.error().message;
  return std::move(made).value();
}

TEST(PrintableLength, IsTheMeasuredOneAtAPointAndAStraightLineBetweenTwo) {
  const PrintableLength p = curve({{30, 40}, {60, 20}, {90, 5}});
  EXPECT_NEAR(p.length_mm(radians(30)), 40, 1e-12);
  EXPECT_NEAR(p.length_mm(radians(45)), 30, 1e-12);
  EXPECT_NEAR(p.length_mm(radians(60)), 20, 1e-12);
  EXPECT_NEAR(p.length_mm(radians(80)), 10, 1e-12);
  EXPECT_NEAR(p.length_mm(radians(90)), 5, 1e-12);
}

TEST(PrintableLength, SteeperThanTheFirstPointIsTheFirstPointsLength) {
  const PrintableLength p = curve({{30, 40}, {90, 5}});
  EXPECT_EQ(p.length_mm(0), 40);
  EXPECT_EQ(p.length_mm(radians(29)), 40);
}

TEST(PrintableLength, NextToAPointWithoutLimitTheShorterOneHolds) {
  const PrintableLength p = curve({{45, std::nullopt}, {60, 20}, {90, 5}});
  EXPECT_TRUE(std::isinf(p.length_mm(0)));
  EXPECT_TRUE(std::isinf(p.length_mm(radians(44.9))));
  EXPECT_EQ(p.length_mm(radians(45.1)), 20);
  EXPECT_EQ(p.length_mm(radians(59)), 20);
}

TEST(PrintableLength, ACurveMayHaveNoLimitAtAll) {
  EXPECT_TRUE(std::isinf(curve({{90, std::nullopt}}).length_mm(radians(90))));
}

TEST(PrintableLength, IsPositiveAndNeverRisesWithTheAngle) {
  const PrintableLength p = curve({{20, std::nullopt}, {35, 60}, {50, 60}, {70, 12}, {90, 3}});
  double before = p.length_mm(0);
  for (double degrees = 0; degrees <= 90; degrees += 0.25) {
    const double here = p.length_mm(radians(degrees));
    EXPECT_LE(here, before) << degrees;
    EXPECT_GT(here, 0) << degrees;
    before = here;
  }
}

TEST(PrintableLength, RoundingBeyondTheEndsCountsAsTheEnd) {
  const PrintableLength p = curve({{0, 80}, {90, 5}});
  EXPECT_EQ(p.length_mm(-1e-12), 80);
  EXPECT_EQ(p.length_mm(std::numbers::pi / 2 + 1e-12), 5);
}

TEST(PrintableLength, WhatIsNoCurveIsRefusedByThePoint) {
  struct Case {
    Points points;
    const char* named;
  };
  const std::vector<Case> cases = {{{}, "0 points"},
                                   {Points(65, {90, 1}), "65 points"},
                                   {{{45, 20}}, "last angle is 45"},
                                   {{{45, 20}, {45, 10}, {90, 5}}, "points[1]"},
                                   {{{45, 20}, {60, 21}, {90, 5}}, "points[1]"},
                                   {{{45, 20}, {90, std::nullopt}}, "points[1]"},
                                   {{{45, 0}, {90, 0}}, "points[0]"},
                                   {{{-1, 20}, {90, 5}}, "points[0]"},
                                   {{{std::nan(""), 20}, {90, 5}}, "points[0]"},
                                   {{{90, std::nan("")}}, "points[0]"}};
  for (const Case& each : cases) {
    const auto made = PrintableLength::make(each.points, false, "");
    ASSERT_FALSE(made.ok()) << each.named;
    EXPECT_NE(made.error().message.find(each.named), std::string::npos) << made.error().message;
  }
}

}  // namespace
}  // namespace skinframe
