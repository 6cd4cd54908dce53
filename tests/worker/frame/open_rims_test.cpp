// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/frame/open_rims.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <numbers>

#include "tests/worker/drain/hollow.h"
#include "worker/frame/sample_frame.h"
#include "worker/frame/sharp_chains.h"

namespace skinframe {
namespace {

SampledFrame sampled_with(const hollow::Body& body, const std::vector<Opening>& openings) {
  FrameOptions options;
  options.plate.tensile_modulus_mpa = 1586;
  options.openings = openings;
  RunContext context;
  auto sampled = sample_frame(body.skin, options, context);
  EXPECT_TRUE(sampled.ok()) << sampled.error().message;
  return std::move(sampled.value());
}

TEST(OpenRims, TheTriangulationEndsAtTheRimAndNoStrutIsInTheOpening) {
  const hollow::Body box = hollow::make(bodies::box(70, 60, 50));
  const Eigen::Vector3d down = -Eigen::Vector3d::UnitZ();
  const std::vector<Opening> openings{{{20, 20, 0}, down, 8, 1, 2}, {{50, 40, 0}, down, 8, 1, 2}};
  const SampledFrame sampled = sampled_with(box, openings);
  EXPECT_THAT(sampled.warnings, testing::IsEmpty());
  EXPECT_EQ(sampled.openings.size(), 2u);
  std::map<std::pair<int, int>, int> sides;
  for (const auto& t : sampled.frame.skin_triangles)
    for (int k = 0; k < 3; ++k) ++sides[{t[k], t[(k + 1) % 3]}];
  int open = 0;
  for (const auto& [side, uses] : sides) {
    EXPECT_EQ(uses, 1);
    if (sides.count({side.second, side.first}) > 0) continue;
    ++open;
    for (const int node : {side.first, side.second}) {
      const Eigen::Vector3d& p = sampled.frame.nodes_mm[node];
      EXPECT_NEAR(p.z(), 1.0, 0.1);
      EXPECT_NEAR(std::min((p - Eigen::Vector3d(20, 20, 1)).norm(), (p - Eigen::Vector3d(50, 40, 1)).norm()),
                  rim_radius_mm(openings[0], 1.0), 0.15);
    }
  }
  EXPECT_EQ(open, 2 * kRimNodes);
  for (const Strut& strut : sampled.frame.struts)
    EXPECT_GE(distance_mm(openings, sampled.frame.nodes_mm[strut.a], sampled.frame.nodes_mm[strut.b]),
              strut.is_skin ? 1.0 : 0.5);
}

TEST(OpenRims, NoTwoVerticesOfAChainStandInOnePlace) {
  const hollow::Body box = hollow::make(bodies::box(70, 60, 50));
  int looked = 0;
  for (int i = 0; i < 40; ++i) {
    const Opening opening{{30 + 0.27 * i, 26 + 0.19 * i, 0}, -Eigen::Vector3d::UnitZ(), 8, 1, 2};
    TriangleMesh piece = box.skin.inner_surface;
    const SharpChains chains(piece, {rim_curve(opening, box.skin)}, 1.5 * box.skin.field.coarse_voxel_mm());
    for (const auto& t : piece.triangles)
      for (int k = 0; k < 3; ++k) {
        if (!chains.is_on(t[k]) || !chains.is_on(t[(k + 1) % 3])) continue;
        ++looked;
        EXPECT_GT((piece.vertices[t[k]] - piece.vertices[t[(k + 1) % 3]]).norm(), 1e-3);
      }
  }
  EXPECT_GT(looked, 40 * kRimNodes);
}

TEST(OpenRims, AnOpeningThatHasNoRoomIsHandedBack) {
  const hollow::Body box = hollow::make(bodies::box(70, 60, 50));
  // Two rims that run through each other.
  const Eigen::Vector3d down = -Eigen::Vector3d::UnitZ();
  const SampledFrame sampled =
      sampled_with(box, {{{30, 30, 0}, down, 8, 1, 2}, {{36, 30, 0}, down, 8, 1, 2}});
  EXPECT_FALSE(sampled.unopened.empty());
  EXPECT_TRUE(sampled.frame.nodes_mm.empty());
}

// A plane about the opening: the hub, the rim and a ring twice as wide; at rim node 1 it is folded back.
TriangleMesh folded_plane(const Opening& opening, std::vector<std::pair<int, int>>* chords) {
  const Across to = across(opening);
  TriangleMesh plane;
  const auto put = [&](double radius, int i) {
    const double angle = 2.0 * std::numbers::pi * i / kRimNodes;
    plane.vertices.push_back(opening.centre_mm - opening.axis +
                             radius * (std::cos(angle) * to.u + std::sin(angle) * to.v));
  };
  const double rim = rim_radius_mm(opening, 1.0);
  for (int i = 0; i < kRimNodes; ++i) put(rim, i);
  for (int i = 0; i < kRimNodes; ++i) put(2.0 * rim, i);
  put(0.0, 0);
  for (int i = 0; i < kRimNodes; ++i) {
    const int next = (i + 1) % kRimNodes, out = kRimNodes + i, out_next = kRimNodes + next;
    chords->emplace_back(i, next);
    plane.triangles.push_back({2 * kRimNodes, i, next});
    if (i == 0) {
      plane.triangles.push_back({i, out, 2});
      plane.triangles.push_back({out, out_next, 2});
    } else if (i == 1) {
      plane.triangles.push_back({2, 1, 0});
      plane.triangles.push_back({next, out, out_next});
    } else {
      plane.triangles.push_back({next, i, out});
      plane.triangles.push_back({next, out, out_next});
    }
  }
  return plane;
}

TEST(OpenRim, WhatIsFoldedBackOverTheOpeningIsUnfolded) {
  const Opening opening{{35, 30, 0}, -Eigen::Vector3d::UnitZ(), 8, 1, 2};
  std::vector<std::pair<int, int>> chords;
  TriangleMesh plane = folded_plane(opening, &chords);
  const auto reach = [&] {
    double least = 1e9;
    for (const auto& t : plane.triangles)
      for (int k = 0; k < 3; ++k)
        least = std::min(least, distance_mm(opening, plane.vertices[t[k]], plane.vertices[t[(k + 1) % 3]]));
    return least;
  };
  ASSERT_TRUE(open_rim(plane, chords, opening, 1.0));
  EXPECT_EQ(plane.vertices.size(), 2u * kRimNodes);
  EXPECT_EQ(plane.triangles.size(), 2u * kRimNodes);
  EXPECT_EQ(chords.size(), static_cast<std::size_t>(kRimNodes));
  EXPECT_GE(reach(), 1.0 + 0.5 * kRimSlackMm);
}

TEST(OpenRim, ChangesNothingWhereNoChainRunsAboutTheOpening) {
  TriangleMesh box = bodies::box(70, 60, 50);
  std::vector<std::pair<int, int>> chords;
  EXPECT_FALSE(open_rim(box, chords, {{35, 30, 0}, -Eigen::Vector3d::UnitZ(), 8, 1, 2}, 1.0));
  EXPECT_EQ(box.triangles.size(), bodies::box(70, 60, 50).triangles.size());
}

}  // namespace
}  // namespace skinframe
