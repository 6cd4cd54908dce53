// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/export/crossings.h"

#include <gtest/gtest.h>

#include <ctime>

#include "tests/worker/skin/bodies.h"
#include "worker/export/untangle.h"
#include "worker/skin/mend_edges.h"

namespace skinframe {
namespace {

TriangleMesh two_boxes(double shift) {
  TriangleMesh mesh = bodies::box(10, 10, 10), other = bodies::box(10, 10, 10);
  for (auto& v : other.vertices) v += Eigen::Vector3d(shift, 1, 1);
  for (const auto& t : other.triangles) mesh.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  return mesh;
}

TEST(Crossings, ASphereHasNone) { EXPECT_TRUE(crossing_triangles(bodies::sphere(10, 4)).empty()); }

TEST(Crossings, BoxesThatOverlapCrossAndBoxesApartDoNot) {
  EXPECT_FALSE(crossing_triangles(two_boxes(5)).empty());
  EXPECT_TRUE(crossing_triangles(two_boxes(11)).empty());
}

// All triangles of such a wall have the same place along one axis, which a sweep along it cannot part.
TEST(Crossings, FlatWallsSquareToTheAxesCostNoMoreThanTurnedOnes) {
  constexpr int kCells = 120;
  const TriangleMesh square =
      bodies::blocks({kCells, kCells, kCells}, {0.5, 0.5, 0.5}, [](int, int, int) { return true; });
  TriangleMesh turned = square;
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, -3).normalized()).matrix();
  for (auto& v : turned.vertices) v = (turn * v).cast<float>().cast<double>();
  const auto cost = [](const TriangleMesh& mesh) {
    const std::clock_t start = std::clock();
    EXPECT_TRUE(crossing_triangles(mesh).empty());
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  };
  const double of_turned = cost(turned);
  EXPECT_LT(cost(square), 3.0 * of_turned);
}

TEST(Crossings, AFoldFlatOntoItsNeighbourIsFound) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.5, 0}};
  mesh.triangles = {{0, 1, 2}, {1, 0, 3}};
  EXPECT_EQ(crossing_triangles(mesh).size(), 1u);
  mesh.vertices[3] = {0.2, -0.5, 0};
  EXPECT_TRUE(crossing_triangles(mesh).empty());
}

TEST(Crossings, ACornerThatPokesThroughItsOwnFanIsFound) {
  // Two triangles share a corner; the far side of one cuts the other.
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {1, 1, 1}, {0.5, 0.5, -1}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 4}};
  EXPECT_EQ(crossing_triangles(mesh).size(), 1u);
}

TEST(Untangle, ASpikePushedThroughTheFarSideComesBack) {
  TriangleMesh mesh = bodies::sphere(10, 4);
  const Eigen::Vector3d centre(0, 0, 10);
  mesh.vertices[0] = (centre - 1.05 * (mesh.vertices[0] - centre)).cast<float>().cast<double>();
  ASSERT_FALSE(crossing_triangles(mesh).empty());
  const auto result = untangle(mesh, RunContext{});
  EXPECT_GT(result.crossings_found, 0);
  EXPECT_EQ(result.crossings_left, 0);
  EXPECT_TRUE(crossing_triangles(mesh).empty());
  EXPECT_EQ(count_bad_edges(mesh), 0);
}

TEST(Untangle, ASurfaceWithoutCrossingsIsNotTouched) {
  TriangleMesh mesh = bodies::torus(20, 8);
  const auto before = mesh.vertices;
  EXPECT_EQ(untangle(mesh, RunContext{}).crossings_found, 0);
  EXPECT_TRUE(before == mesh.vertices);
}

}  // namespace
}  // namespace skinframe
