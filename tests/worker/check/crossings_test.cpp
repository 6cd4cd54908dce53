// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <array>
#include <random>
#include <set>
#include <vector>

#include "worker/check/claims.h"
#include "worker/check/near_boxes.h"
#include "worker/check/surface.h"

namespace skinframe::check {
namespace {

TEST(NearBoxes, FindsTheSamePairsAsLookingAtAll) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(0.0, 10.0), small(0.0, 0.5);
  std::vector<Eigen::AlignedBox3d> boxes;
  for (int i = 0; i < 600; ++i) {
    const Eigen::Vector3d low(place(random), place(random), place(random));
    const double size = i % 50 == 0 ? 12.0 : 1.0;  // some reach over all columns
    boxes.emplace_back(low, low + size * Eigen::Vector3d(small(random), small(random), small(random)));
  }
  std::set<std::pair<int, int>> all, found;
  for (int i = 0; i < 600; ++i)
    for (int j = i + 1; j < 600; ++j)
      if (boxes[i].intersects(boxes[j])) all.insert({i, j});
  for_each_overlap(boxes, [&](int i, int j) { EXPECT_TRUE(found.insert({i, j}).second); });
  EXPECT_GT(all.size(), 100u);
  EXPECT_EQ(found, all);
}

TEST(CountCrossings, TellsThoseOfTheInputFromThoseAdded) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {4, 0, 0},  {0, 4, 0}, {1, 1, -1}, {1, 1, 1},
                   {2, 1, 1}, {1, 2, -1}, {1, 2, 1}, {1.5, 2, 0}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}};
  EXPECT_EQ(count_crossings(mesh, 2).own, 1u);
  EXPECT_EQ(count_crossings(mesh, 2).added, 1u);
  EXPECT_EQ(count_crossings(mesh, 3).own, 2u);
  EXPECT_EQ(count_crossings(mesh, 0).added, 2u);
}

TEST(CountCrossings, NeighboursAndTouchingDoNotCountButAFoldDoes) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, -4, 0}, {-4, 0, 1}, {2, 1, 0}, {2, 2, 3}, {3, 1, 3}};
  mesh.triangles = {{0, 1, 2}, {1, 0, 3}, {0, 4, 3}, {5, 6, 7}};  // a side, corners, a tip on the face
  EXPECT_EQ(count_crossings(mesh, 0).added, 0u);
  mesh.triangles = {{0, 1, 2}, {1, 0, 5}};
  EXPECT_EQ(count_crossings(mesh, 0).added, 1u);
}

TEST(Surface, WhatItEnclosesTwiceIsInside) {
  // Two cubes of 4 that share a corner's 2 x 2 x 2.
  TriangleMesh mesh;
  for (const double low : {0.0, 2.0})
    for (int i = 0; i < 8; ++i)
      mesh.vertices.emplace_back(low + (i & 1 ? 4 : 0), low + (i & 2 ? 4 : 0), low + (i & 4 ? 4 : 0));
  for (const int k : {0, 8})
    for (const auto& [a, b, c] : std::vector<std::array<int, 3>>{{0, 2, 1},
                                                                 {1, 2, 3},
                                                                 {4, 5, 6},
                                                                 {5, 7, 6},
                                                                 {0, 1, 4},
                                                                 {1, 5, 4},
                                                                 {2, 6, 3},
                                                                 {3, 6, 7},
                                                                 {0, 4, 2},
                                                                 {2, 4, 6},
                                                                 {1, 3, 5},
                                                                 {3, 7, 5}})
      mesh.triangles.push_back({k + a, k + b, k + c});
  const Surface surface(mesh);
  EXPECT_NEAR(surface.depth_mm({3, 3, 3}), 1, 1e-9);
  EXPECT_NEAR(surface.depth_mm({1, 1.2, 1}), 1, 1e-9);
  EXPECT_NEAR(surface.depth_mm({5.5, 5, 4}), 0.5, 1e-9);
  EXPECT_NEAR(surface.depth_mm({1, 5, 1}), -1, 1e-9);
  EXPECT_NEAR(surface.depth_mm({-2, 1, 1}), -2, 1e-9);
}

}  // namespace
}  // namespace skinframe::check
