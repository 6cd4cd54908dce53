// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/skin/mend_edges.h"

#include <gtest/gtest.h>

#include "tests/worker/skin/bodies.h"

namespace skinframe {
namespace {

TEST(MendEdges, LeavesAManifoldAlone) {
  TriangleMesh mesh = bodies::box(1, 2, 3);
  const EdgeMending mending = mend_edges(mesh);
  EXPECT_TRUE(mending.manifold);
  EXPECT_EQ(mending.edges_split, 0);
  EXPECT_EQ(mesh.triangles.size(), 12u);
}

TEST(MendEdges, PartsTwoCubesThatShareAnEdge) {
  TriangleMesh mesh = bodies::blocks({2, 2, 1}, {1, 1, 1}, [](int x, int y, int) { return x == y; });
  ASSERT_EQ(count_bad_edges(mesh), 1);
  const EdgeMending mending = mend_edges(mesh);
  EXPECT_TRUE(mending.manifold);
  EXPECT_EQ(mending.edges_split, 1);
  EXPECT_EQ(count_bad_edges(mesh), 0);
  EXPECT_NEAR(signed_volume(mesh), 2.0, 0.05);
}

TEST(MendEdges, PartsEveryEdgeOfACheckerboard) {
  TriangleMesh mesh =
      bodies::blocks({4, 4, 4}, {1, 1, 1}, [](int x, int y, int z) { return (x + y + z) % 2 == 0; });
  ASSERT_GT(count_bad_edges(mesh), 50);
  EXPECT_TRUE(mend_edges(mesh).manifold);
  EXPECT_EQ(count_bad_edges(mesh), 0);
  EXPECT_NEAR(signed_volume(mesh), 32.0, 3.0);
}

// So short an edge that a fiftieth of it is lost in floats.
TEST(MendEdges, PartsTwoPlatesThatShareATinyEdgeFarFromTheOrigin) {
  TriangleMesh mesh = bodies::blocks({2, 2, 1}, {1, 1, 3e-5}, [](int x, int y, int) { return x == y; });
  for (auto& v : mesh.vertices) v += Eigen::Vector3d(150, 150, 0);
  ASSERT_EQ(count_bad_edges(mesh), 1);
  EXPECT_TRUE(mend_edges(mesh).manifold);
  EXPECT_EQ(count_bad_edges(mesh), 0);
}

TEST(MendEdges, WeldsWhatFallsTogetherInFloat) {
  TriangleMesh mesh = bodies::sphere(1.0, 3);
  for (auto& v : mesh.vertices) v *= 1e-7;     // a sphere smaller than a float's step
  for (auto& v : mesh.vertices) v.x() += 1.0;  // at x = 1
  const EdgeMending mending = mend_edges(mesh);
  EXPECT_TRUE(mending.manifold);
  EXPECT_EQ(count_bad_edges(mesh), 0);
  for (const auto& v : mesh.vertices) EXPECT_EQ(v, v.cast<float>().cast<double>());
}

TEST(MendEdges, SaysSoWhenTheSurfaceIsOpen) {
  TriangleMesh mesh = bodies::box(1, 1, 1);
  mesh.triangles.pop_back();
  EXPECT_FALSE(mend_edges(mesh).manifold);
  EXPECT_EQ(count_bad_edges(mesh), 3);
}

}  // namespace
}  // namespace skinframe
