// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/frame/node_count.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/worker/skin/bodies.h"

namespace skinframe {
namespace {

TEST(FingerRule, GivesTheDesignsFiguresForBothPrinters) {
  EXPECT_NEAR(finger_edge_mm({.tensile_modulus_mpa = 1586}, 1.0), 21.3, 0.05);
  EXPECT_NEAR(finger_edge_mm({.tensile_modulus_mpa = 2673}, 0.8), 19.8, 0.05);
}

TEST(ChordRule, EdgesOfASphereAreThoseWhoseChordSagsByOneThickness) {
  const TriangleMesh mesh = bodies::sphere(30.0, 5);
  const auto length = edge_length_field(mesh, 1000.0, 1.0);
  const double expected = std::sqrt(8.0 * 30.0 * 1.0);  // 15.5 mm
  for (double a : length) ASSERT_NEAR(a, expected, 0.05 * expected);
  const double area = 4.0 * std::numbers::pi * 900.0;
  EXPECT_NEAR(node_demand(mesh, length), 2.0 * area / (std::sqrt(3.0) * expected * expected), 4.0);
}

TEST(ChordRule, TorusAsksForTheCurvatureOfItsTube) {
  const TriangleMesh mesh = bodies::torus(60.0, 15.0, 240, 60);
  for (double a : edge_length_field(mesh, 1000.0, 1.0)) ASSERT_NEAR(a, std::sqrt(8.0 * 15.0), 1.0);
}

TEST(EdgeLengthField, FlatSurfaceIsLeftToTheFingerRule) {
  const TriangleMesh mesh = bodies::blocks({60, 60, 2}, {2, 2, 2}, [](int, int, int) { return true; });
  const auto length = edge_length_field(mesh, 20.0, 1.0);
  double longest = 0.0, shortest = 1e9;
  for (double a : length) longest = std::max(longest, a), shortest = std::min(shortest, a);
  EXPECT_NEAR(longest, 20.0, 0.1);
  EXPECT_GE(shortest, kEdgeFloorInThicknesses - 1e-9);
}

TEST(EdgeLengthField, NeverShorterThanTheFloorAndGraded) {
  const TriangleMesh mesh = bodies::blocks({20, 20, 20}, {2, 2, 2}, [](int, int, int) { return true; });
  const auto length = edge_length_field(mesh, 21.0, 1.0);
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      ASSERT_GE(length[a], kEdgeFloorInThicknesses - 1e-9);
      ASSERT_LE(length[a] - length[b], kEdgeGrading * (mesh.vertices[a] - mesh.vertices[b]).norm() + 1e-9);
    }
  }
}

}  // namespace
}  // namespace skinframe
