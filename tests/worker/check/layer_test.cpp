// SPDX-License-Identifier: GPL-3.0-or-later
// Layers of bodies whose answer is known.
#include <gtest/gtest.h>

#include "worker/check/claims.h"

namespace skinframe::check {
namespace {

// A frustum upright about the z axis, square, of the half widths given at its ends.
TriangleMesh frustum(double low_half, double low_z, double high_half, double high_z, double x = 0) {
  TriangleMesh mesh;
  for (const auto& [h, z] : {std::pair{low_half, low_z}, std::pair{high_half, high_z}})
    for (const auto& [sx, sy] : {std::pair{-1, -1}, std::pair{1, -1}, std::pair{1, 1}, std::pair{-1, 1}})
      mesh.vertices.emplace_back(x + sx * h, sy * h, z);
  mesh.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}};
  for (int k = 0; k < 4; ++k) {
    const int next = (k + 1) % 4;
    mesh.triangles.push_back({k, next, next + 4});
    mesh.triangles.push_back({k, next + 4, k + 4});
  }
  return mesh;
}

// Along x, as thin as a sliver across.
TriangleMesh ridge(double from_x, double to_x, double half_width, double low_z, double high_z) {
  TriangleMesh mesh = frustum(1, low_z, 1, high_z);
  for (Eigen::Vector3d& v : mesh.vertices) {
    v.x() = v.x() < 0 ? from_x : to_x;
    v.y() *= half_width;
  }
  return mesh;
}

void add(TriangleMesh& to, const TriangleMesh& mesh) {
  const int first = static_cast<int>(to.vertices.size());
  to.vertices.insert(to.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
  for (const auto& t : mesh.triangles) to.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

bool holds(const TriangleMesh& merged, const TriangleMesh& external = {}) {
  ExportedPrinter result;
  result.eta_mm = 0.4;
  result.merged = merged;
  result.supports.emplace();
  result.supports->self_supporting_angle_deg = 45;
  result.supports->plate_reach_mm = 1;
  result.supports->external_mesh = external;
  Verdict verdict;
  claim_layers(result, &verdict);
  EXPECT_EQ(verdict.claims.size(), 1u);
  return !verdict.claims.empty() && verdict.claims.front().holds;
}

TEST(LayerClaim, WhatStandsOnThePlateAndGrowsSlowlyHolds) {
  EXPECT_GT(signed_volume(frustum(3, 0, 8, 6)), 0) << "outward";
  EXPECT_TRUE(holds(frustum(3, 0, 8, 6)));
}

TEST(LayerClaim, ABlockInTheAirIsSeen) {
  TriangleMesh body = frustum(5, 0, 5, 10);
  add(body, frustum(2, 4, 2, 10, 20));
  EXPECT_FALSE(holds(body));
}

TEST(LayerClaim, ATipThatComesDownBesideTheBodyIsSeenThoughItIsOneBodyHigherUp) {
  TriangleMesh body = frustum(5, 0, 5, 20);
  add(body, frustum(0.8, 8, 4, 14, 8));  // joins the column at half its height
  EXPECT_FALSE(holds(body));
}

// Layers of 0.4 mm lie at 0.2, 0.6 and so on: one goes through the ridge at 10.2, the next through the deck.
TEST(LayerClaim, ASliverThatComesUpBelowALevelDeckIsNoLineOfASlicer) {
  TriangleMesh body = frustum(5, 0, 5, 10.4);
  add(body, ridge(-20, 20, 4, 10.4, 12));  // bridges from the column
  ASSERT_TRUE(holds(body));
  TriangleMesh thin = body, wide = body;
  add(thin, ridge(10, 16, 0.17, 10.1, 10.5));
  EXPECT_TRUE(holds(thin)) << "narrower than a cell";
  add(wide, ridge(10, 16, 0.6, 10.1, 10.5));
  EXPECT_FALSE(holds(wide)) << "as wide as three cells";
}

TEST(LayerClaim, ASliverHoldsNothing) {
  TriangleMesh body = frustum(5, 0, 5, 20);
  add(body, ridge(10, 16, 0.17, 10.1, 10.5));
  add(body, frustum(2, 10.4, 2, 14, 13));
  EXPECT_FALSE(holds(body)) << "the block above it starts in the air";
}

TEST(LayerClaim, ASupportOutsideHoldsWhatWouldStartInTheAir) {
  TriangleMesh body = frustum(5, 0, 5, 10);
  add(body, frustum(2, 4, 2, 10, 20));
  EXPECT_TRUE(holds(body, frustum(0.6, 0, 0.6, 4.5, 20)));
  EXPECT_FALSE(holds(body, frustum(0.6, 0, 0.6, 3.0, 20))) << "it ends too low";
  EXPECT_FALSE(holds(body, frustum(0.6, 0, 0.6, 4.5, 12))) << "it stands beside";
}

TEST(LayerClaim, FiguresThatMakeNoSenseTakeNoMoreThanTheOthers) {
  ExportedPrinter result;  // a plate far below, all angles print
  result.eta_mm = 0.4;
  result.merged = frustum(5, 0, 5, 10);
  result.supports.emplace();
  result.supports->self_supporting_angle_deg = 90;
  result.supports->plate_z_mm = -1e9;
  Verdict verdict;
  claim_layers(result, &verdict);
  EXPECT_FALSE(verdict.claims.front().holds) << "it stands on nothing";
}

TEST(LayerClaim, ACavityIsNoMaterial) {
  // A box of 20 mm with a cavity of 18: a block that hangs free in it starts in the air.
  TriangleMesh body = frustum(10, 0, 10, 20);
  TriangleMesh cavity = frustum(9, 1, 9, 19);
  for (auto& t : cavity.triangles) std::swap(t[1], t[2]);
  add(body, cavity);
  EXPECT_TRUE(holds(body)) << "the roof touches the walls: how far it reaches is another claim";
  add(body, frustum(2, 8, 2, 12));
  EXPECT_FALSE(holds(body));
}

}  // namespace
}  // namespace skinframe::check
