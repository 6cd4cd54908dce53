// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/export/thin_out.h"

#include <gtest/gtest.h>

#include "tests/worker/skin/bodies.h"
#include "worker/skin/mend_edges.h"

namespace skinframe {
namespace {

TEST(ThinOut, BoxOfManyTrianglesKeepsItsShapeWithFew) {
  TriangleMesh mesh = bodies::blocks({12, 12, 12}, {1, 1, 1}, [](int, int, int) { return true; });
  thin_out(mesh, 200, 1e-3);
  EXPECT_LE(mesh.triangles.size(), 400u);
  EXPECT_EQ(count_bad_edges(mesh), 0);
  EXPECT_EQ(bodies::euler_characteristic(mesh), 2);
  EXPECT_NEAR(signed_volume(mesh), 1728.0, 0.1);
}

TEST(ThinOut, TorusKeepsItsHoleAndItsVolumeWithinTheTolerance) {
  TriangleMesh mesh = bodies::torus(20, 6, 200, 100);
  const double volume = signed_volume(mesh), area = surface_area(mesh);
  thin_out(mesh, 1000, 0.05);
  EXPECT_LT(mesh.triangles.size(), 20000u);
  EXPECT_EQ(count_bad_edges(mesh), 0);
  EXPECT_EQ(bodies::euler_characteristic(mesh), 0);
  EXPECT_NEAR(signed_volume(mesh), volume, 0.05 * area);
}

TEST(ThinOut, LeavesASmallEnoughMeshAlone) {
  TriangleMesh mesh = bodies::box(1, 2, 3);
  const auto before = mesh.triangles;
  thin_out(mesh, 12, 1.0);
  EXPECT_EQ(mesh.triangles, before);
}

TEST(ThinOut, CutsNoEdgeShortOfTheTolerance) {
  // Steps of 1 mm are all there is: a tolerance of a hundredth may not flatten them.
  TriangleMesh mesh =
      bodies::blocks({9, 9, 1}, {1, 1, 1}, [](int x, int y, int) { return (x % 2 == 0) || y == 4; });
  const double volume = signed_volume(mesh);
  thin_out(mesh, 4, 0.01);
  EXPECT_NEAR(signed_volume(mesh), volume, 0.02 * volume);
}

}  // namespace
}  // namespace skinframe
