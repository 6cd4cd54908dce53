// SPDX-License-Identifier: GPL-3.0-or-later
// What the comparison says, in words and by row.
#include "worker/verify/verification.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "worker/verify/coloured_skin.h"

namespace skinframe {
namespace {

using testing::HasSubstr;

DesignFigures design(double displacement, double pinch, double buckling) {
  LoadFigures load;
  load.name = "side";
  load.max_displacement_mm = displacement;
  load.skin_stress_mpa = 2;
  load.strut_stress_mpa = 3;
  load.buckling_factor = buckling;
  DesignFigures d;
  d.loads.push_back(load);
  PinchFigures pinches;
  pinches.mean_mm = pinch / 2;
  pinches.max_mm = pinch;
  d.pinch = pinches;
  return d;
}

Verification of(const DesignFigures& ours, const DesignFigures& hollow) {
  Verification v;
  v.ours = ours;
  v.hollow = hollow;
  v.hollow_wall_mm = 2.25;
  return v;
}

TEST(Verification, AFrameThatHollowBeatsInEveryRowIsToldSoWithTheWallThatWouldDo) {
  const std::string verdict = verdict_of(of(design(2, 1, 3), design(1, 0.5, 9)));
  EXPECT_THAT(verdict, HasSubstr("uniform hollow of 2.25 mm wall"));
  EXPECT_THAT(verdict, HasSubstr("it would do"));
  EXPECT_THAT(verdict, HasSubstr("pinch_max_mm"));
}

TEST(Verification, WhatDrawsEverywhereDoesNotWin) {
  const std::string verdict = verdict_of(of(design(1, 1, 3), design(1.001, 0.999, 3.01)));
  EXPECT_THAT(verdict, HasSubstr("does as well in everything"));
}

TEST(Verification, RowsAreWonBySmallerDisplacementAndLargerBucklingFactor) {
  const auto rows = compare(of(design(1, 2, 5), design(2, 1, 4)));
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[0].winner, Winner::kSkinFrame);  // displacement
  EXPECT_EQ(rows[1].winner, Winner::kHollow);     // pinch
  EXPECT_EQ(rows[2].winner, Winner::kHollow);
  EXPECT_EQ(rows[3].winner, Winner::kSkinFrame);  // buckling
  EXPECT_THAT(verdict_of(of(design(1, 2, 5), design(2, 1, 4))),
              HasSubstr("worse in pinch_mean_mm, pinch_max_mm"));
}

TEST(Verification, WithoutAHollowNothingIsClaimedAboutIt) {
  Verification v;
  v.ours = design(1, 1, 1);
  v.hollow_missing = "it falls apart";
  EXPECT_THAT(verdict_of(v), HasSubstr("not compared"));
  for (const ComparedRow& row : compare(v)) EXPECT_EQ(row.winner, Winner::kNeither);
}

// w = 1 + a h^order on meshes of spacing 4, 2, 1: the limit is 1.
TEST(Verification, ErrorOfTheFinestMeshIsThatOfItsOrderFromOneToTwo) {
  const auto works = [](double a, double order) {
    std::vector<std::vector<double>> w;
    for (const double h : {4.0, 2.0, 1.0}) w.push_back({1 + a * std::pow(h, order)});
    return w;
  };
  for (const double order : {1.0, 1.5, 2.0})
    for (const double a : {0.01, -0.01})
      EXPECT_NEAR(mesh_error_of(works(a, order), {0}), 0.01 / (1 + a), 1e-12);
  // A lower order is not believed, nor a higher one.
  EXPECT_NEAR(mesh_error_of({{1.3}, {1.2}, {1.1}}, {0}), 0.1 / 1.1, 1e-12);
  EXPECT_NEAR(mesh_error_of({{3.0}, {1.03}, {1.0}}, {0}), 0.01, 1e-12);
  // Two meshes, or changes to and fro: the last change.
  EXPECT_NEAR(mesh_error_of({{1.2}, {1.0}}, {0}), 0.2, 1e-12);
  EXPECT_NEAR(mesh_error_of({{0.5}, {1.2}, {1.0}}, {0}), 0.2, 1e-12);
  // The worst load counts.
  EXPECT_NEAR(mesh_error_of({{1.0, 1.0}, {1.0, 2.0}}, {0, 0}), 0.5, 1e-12);
  // What moves less than anybody asks for counts by what they ask for.
  EXPECT_NEAR(mesh_error_of({{1.2}, {1.0}}, {10}), 0.02, 1e-12);
}

TEST(Verification, AMeshThatIsTooCoarseIsToldSo) {
  Verification v;
  v.mesh_error = 0.02;
  EXPECT_THAT(mesh_words(v), HasSubstr("known to 2 %"));
  v.mesh_error = 0.088;
  EXPECT_THAT(mesh_words(v), HasSubstr("known to 8.8 % only, not to the 5 % aimed at"));
}

TEST(Verification, PinchFiguresAreThoseOfTheSites) {
  std::vector<PinchedSite> sites(3);
  sites[0].closing_mm = sites[2].closing_mm = 0.1;
  sites[1].closing_mm = 0.4;
  const PinchFigures pinch = figures_of_sites(sites);
  EXPECT_DOUBLE_EQ(pinch.mean_mm, 0.2);
  EXPECT_DOUBLE_EQ(pinch.max_mm, 0.4);
  EXPECT_EQ(pinch.worst, 1);
}

TEST(Verification, ColoursRunFromBlueToRed) {
  EXPECT_THAT(colour_of(0), testing::ElementsAre(0, 0, 255));
  EXPECT_THAT(colour_of(1), testing::ElementsAre(255, 0, 0));
  EXPECT_THAT(colour_of(0.5), testing::ElementsAre(128, 255, 128));
}

}  // namespace
}  // namespace skinframe
