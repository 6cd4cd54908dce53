// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/frame/follow_skin.h"

#include <gtest/gtest.h>

#include "tests/worker/fixture/skin_of.h"
#include "tests/worker/skin/bodies.h"
#include "worker/skin/mend_edges.h"

namespace skinframe {
namespace {

using test::skin_of;

// M1 of a body of revolution or a sphere, as a mesh of few triangles inscribed in it.
TriangleMesh shrunk_sphere(double radius, int levels) {
  TriangleMesh mesh = bodies::sphere(radius - 1.0, levels);
  for (auto& v : mesh.vertices) v.z() += 1.0;
  return mesh;
}
TriangleMesh shrunk_torus(double ring, double tube, int around, int across) {
  TriangleMesh mesh = bodies::torus(ring, tube - 1.0, around, across);
  for (auto& v : mesh.vertices) v.z() += 1.0;
  return mesh;
}

void expect_follows(const TriangleMesh& mesh, const Skin& skin) {
  EXPECT_EQ(count_bad_edges(mesh), 0);
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const auto [outward, inward] =
          chord_deviation(mesh.vertices[t[k]], mesh.vertices[t[(k + 1) % 3]], skin);
      EXPECT_LE(outward, kOutwardInThicknesses * skin.thickness_mm + 0.1);
      EXPECT_LE(inward, kInwardInThicknesses * skin.thickness_mm + 0.1);
    }
}

std::vector<std::pair<int, int>> none;

TEST(FollowSkin, ChordOfASphereSinksByItsSagitta) {
  const Skin skin = skin_of(bodies::sphere(20));
  const Eigen::Vector3d centre(0, 0, 20), a(19, 0, 0), b(0, 19, 0);
  const auto [outward, inward] = chord_deviation(centre + a, centre + b, skin);
  EXPECT_NEAR(inward, 19.0 * (1.0 - std::sqrt(0.5)), 0.1);
  EXPECT_NEAR(outward, 0.0, 0.05);
}

// A chord that is kept is divided and not flipped, and its halves are told.
TEST(FollowSkin, AKeptEdgeEndsAsAPathBetweenItsEnds) {
  const Skin skin = skin_of(bodies::torus(24, 9));
  TriangleMesh mesh = shrunk_torus(24, 9, 9, 8);
  std::vector<std::pair<int, int>> kept{{mesh.triangles[0][0], mesh.triangles[0][1]}};
  const auto [from, to] = kept[0];
  ASSERT_TRUE(follow_skin(mesh, {}, kept, skin, RunContext{}).ok());
  std::map<int, int> degree;
  for (const auto& [a, b] : kept) {
    ++degree[a];
    ++degree[b];
  }
  EXPECT_EQ(degree.size(), kept.size() + 1);
  for (const auto& [node, count] : degree) EXPECT_EQ(count, node == from || node == to ? 1 : 2);
}

TEST(FollowSkin, WhatFollowsAlreadyKeepsItsNodesWhereTheyAreHeld) {
  const Skin skin = skin_of(bodies::sphere(20));
  TriangleMesh mesh = shrunk_sphere(20, 2);
  const TriangleMesh before = mesh;
  const auto done = follow_skin(mesh, std::vector<char>(mesh.vertices.size(), 1), none, skin, RunContext{});
  ASSERT_TRUE(done.ok());
  EXPECT_EQ(done->nodes_added, 0);
  EXPECT_EQ(mesh.vertices, before.vertices);
  EXPECT_EQ(mesh.triangles.size(), before.triangles.size());
}

TEST(FollowSkin, EdgesAcrossAWaistAreDividedUntilTheyFollowIt) {
  // On the inner side of the ring a chord of 40 degrees leaves M1 by 0.96 mm, outwards.
  const Skin skin = skin_of(bodies::torus(24, 9));
  TriangleMesh mesh = shrunk_torus(24, 9, 9, 8);
  const auto nodes = mesh.vertices.size();
  const auto done = follow_skin(mesh, {}, none, skin, RunContext{});
  ASSERT_TRUE(done.ok());
  EXPECT_GT(done->nodes_added, 0);
  EXPECT_EQ(mesh.vertices.size(), nodes + done->nodes_added);
  EXPECT_EQ(done->edges_left, 0);
  EXPECT_EQ(bodies::euler_characteristic(mesh), 0);
  for (const auto& v : mesh.vertices) EXPECT_NEAR(skin.field.at(v), -1.0, 0.2);
  expect_follows(mesh, skin);
}

TEST(FollowSkin, GrowthIsBoundedAndWhatIsLeftIsCounted) {
  const Skin skin = skin_of(bodies::sphere(25));
  TriangleMesh mesh = shrunk_sphere(25, 0);  // an icosahedron: every edge sinks by 3.6 mm
  const auto done = follow_skin(mesh, {}, none, skin, RunContext{});
  ASSERT_TRUE(done.ok());
  EXPECT_LE(mesh.vertices.size(), static_cast<std::size_t>(12 * (1.0 + kMostAdded)));
  EXPECT_GT(done->edges_left, 0);
  EXPECT_EQ(count_bad_edges(mesh), 0);
}

TEST(FollowSkin, PointIsBroughtToTheNearestOfM1) {
  const Skin skin = skin_of(bodies::sphere(20));
  const Eigen::Vector3d centre(0, 0, 20), direction = Eigen::Vector3d(1, 2, 2) / 3.0;
  for (const double depth : {12.0, 17.0, 19.5})
    EXPECT_LT((onto_m1(centre + depth * direction, skin) - (centre + 19.0 * direction)).norm(), 0.1) << depth;
}

}  // namespace
}  // namespace skinframe
