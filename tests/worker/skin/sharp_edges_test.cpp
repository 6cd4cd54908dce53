// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/skin/sharp_edges.h"

#include <gtest/gtest.h>

#include "tests/worker/skin/bodies.h"
#include "worker/skin/build_skin.h"

namespace skinframe {
namespace {

std::vector<SharpCurve> edges_of(const TriangleMesh& body) {
  RunContext context;
  auto skin = build_skin(body, SkinOptions{}, context);
  EXPECT_TRUE(skin.ok()) << skin.error().message;
  return skin->sharp_edges;
}

// A prism over a regular polygon, which is a cylinder to the eye.
TriangleMesh cylinder(double radius, double height, int sides) {
  TriangleMesh mesh;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    for (const double z : {0.0, height})
      mesh.vertices.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
  }
  mesh.vertices.emplace_back(0, 0, 0);
  mesh.vertices.emplace_back(0, 0, height);
  for (int i = 0; i < sides; ++i) {
    const int a = 2 * i, b = 2 * ((i + 1) % sides);
    mesh.triangles.push_back({a, b, b + 1});
    mesh.triangles.push_back({a, b + 1, a + 1});
    mesh.triangles.push_back({b, a, 2 * sides});
    mesh.triangles.push_back({a + 1, b + 1, 2 * sides + 1});
  }
  return bodies::as_stored(mesh);
}

TEST(SharpEdges, OfABoxAreTheTwelveOfTheBoxWithin) {
  const auto edges = edges_of(bodies::box(40, 30, 20));
  ASSERT_EQ(edges.size(), 12u);
  const Eigen::Vector3d low(1, 1, 1), high(39, 29, 19);
  double length = 0;
  for (const SharpCurve& edge : edges) {
    EXPECT_FALSE(edge.closed);
    length += edge.length_mm();
    for (const Eigen::Vector3d& p : edge.points_mm) {
      int at_a_face = 0;
      for (int k = 0; k < 3; ++k)
        at_a_face += std::min(std::abs(p[k] - low[k]), std::abs(p[k] - high[k])) < 1e-6;
      EXPECT_GE(at_a_face, 2) << p.transpose();
    }
  }
  EXPECT_NEAR(length, 4 * (38 + 28 + 18), 1e-6);
}

TEST(SharpEdges, RoundBodiesHaveNone) {
  EXPECT_TRUE(edges_of(bodies::sphere(15)).empty());
  EXPECT_TRUE(edges_of(bodies::torus(20, 8)).empty());
}

TEST(SharpEdges, RimsOfACylinderAreTwoLoops) {
  const auto edges = edges_of(cylinder(15, 20, 96));
  ASSERT_EQ(edges.size(), 2u);
  for (const SharpCurve& edge : edges) {
    EXPECT_TRUE(edge.closed);
    EXPECT_NEAR(edge.length_mm(), 2 * std::numbers::pi * 14, 0.2);
  }
}

// Where two faces meet inwards the offset is round: five of the six upright edges of an L.
TEST(SharpEdges, AnInwardEdgeIsNone) {
  const auto edges =
      edges_of(bodies::blocks({2, 2, 1}, {20, 20, 20}, [](int x, int y, int) { return x == 0 || y == 0; }));
  EXPECT_EQ(edges.size(), 17u);
  int upright = 0;
  for (const SharpCurve& edge : edges)
    upright += (edge.points_mm.front() - edge.points_mm.back()).head<2>().norm() < 1e-6;
  EXPECT_EQ(upright, 5);
}

}  // namespace
}  // namespace skinframe
