// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/export/thin_out.h"

#include <gtest/gtest.h>

#include "tests/worker/skin/bodies.h"
#include "worker/export/crossings.h"
#include "worker/skin/mend_edges.h"
#include "worker/skin/triangle_tree.h"

namespace skinframe {
namespace {

TEST(ThinOut, BoxOfManyTrianglesKeepsItsShapeWithFew) {
  TriangleMesh mesh = bodies::blocks({12, 12, 12}, {1, 1, 1}, [](int, int, int) { return true; });
  thin_out(mesh, {.triangles = 200, .max_deviation_mm = 1e-3}, RunContext{});
  EXPECT_LE(mesh.triangles.size(), 400u);
  EXPECT_EQ(count_bad_edges(mesh), 0);
  EXPECT_EQ(bodies::euler_characteristic(mesh), 2);
  EXPECT_NEAR(signed_volume(mesh), 1728.0, 0.1);
}

TEST(ThinOut, TorusKeepsItsHoleAndItsVolumeWithinTheTolerance) {
  TriangleMesh mesh = bodies::torus(20, 6, 200, 100);
  const double volume = signed_volume(mesh), area = surface_area(mesh);
  thin_out(mesh, {.triangles = 1000, .max_deviation_mm = 0.05}, RunContext{});
  EXPECT_LT(mesh.triangles.size(), 20000u);
  EXPECT_EQ(count_bad_edges(mesh), 0);
  EXPECT_EQ(bodies::euler_characteristic(mesh), 0);
  EXPECT_NEAR(signed_volume(mesh), volume, 0.05 * area);
}

TEST(ThinOut, LeavesASmallEnoughMeshAlone) {
  TriangleMesh mesh = bodies::box(1, 2, 3);
  const auto before = mesh.triangles;
  thin_out(mesh, {.triangles = 12, .max_deviation_mm = 1.0}, RunContext{});
  EXPECT_EQ(mesh.triangles, before);
}

TEST(ThinOut, CutsNoEdgeShortOfTheTolerance) {
  // Steps of 1 mm are all there is: a tolerance of a hundredth may not flatten them.
  TriangleMesh mesh =
      bodies::blocks({9, 9, 1}, {1, 1, 1}, [](int x, int y, int) { return (x % 2 == 0) || y == 4; });
  const double volume = signed_volume(mesh);
  thin_out(mesh, {.triangles = 4, .max_deviation_mm = 0.01}, RunContext{});
  EXPECT_NEAR(signed_volume(mesh), volume, 0.02 * volume);
}

TEST(ThinOut, SheetsNearerThanTheDeviationDoNotMeet) {
  // A ball of 10 mm within one of 10.1 mm: each alone may move by 0.3 mm.
  TriangleMesh mesh = bodies::sphere(10.1, 5);
  const TriangleMesh inner = bodies::sphere(10, 5);
  const int first = static_cast<int>(mesh.vertices.size());
  for (const auto& v : inner.vertices)
    mesh.vertices.push_back(v + Eigen::Vector3d(0, 0, 0.1));  // both stand on 0
  for (const auto& t : inner.triangles) mesh.triangles.push_back({first + t[0], first + t[2], first + t[1]});
  for (auto& v : mesh.vertices) v = v.cast<float>().cast<double>();
  const std::size_t before = mesh.triangles.size();
  ASSERT_TRUE(crossing_triangles(mesh).empty());
  const Thinned thinned = thin_out(mesh, {.triangles = 1000, .max_deviation_mm = 0.3}, RunContext{});
  EXPECT_LT(mesh.triangles.size(), before / 4);
  EXPECT_LE(thinned.deviation_mm, 0.3);
  EXPECT_EQ(count_bad_edges(mesh), 0);
  EXPECT_TRUE(crossing_triangles(mesh).empty());
}

TEST(ThinOut, NoCornerOfTheMeshAsItWasIsFurtherThanItSays) {
  const TriangleMesh before = bodies::torus(20, 6, 200, 100);
  TriangleMesh mesh = before;
  const Thinned thinned = thin_out(mesh, {.triangles = 2000, .max_deviation_mm = 0.1}, RunContext{});
  const TriangleTree tree(mesh);
  double furthest = 0.0;
  for (const auto& v : before.vertices) furthest = std::max(furthest, tree.distance_mm(v));
  EXPECT_GT(thinned.deviation_mm, 0.0);
  EXPECT_LE(thinned.deviation_mm, 0.1);
  EXPECT_LE(furthest, thinned.deviation_mm + 1e-5);  // places of points are floats
}

}  // namespace
}  // namespace skinframe
