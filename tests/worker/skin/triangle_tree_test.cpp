// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/skin/triangle_tree.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <random>

#include "tests/worker/skin/bodies.h"
#include "worker/skin/box_tree.h"
#include "worker/skin/nearest_on_triangle.h"

namespace skinframe {
namespace {

class Random {
 public:
  Eigen::Vector3d point(double most) { return {coordinate(most), coordinate(most), coordinate(most)}; }
  double coordinate(double most) {
    return most * (2.0 * static_cast<double>(generator_()) / 0xffffffffu - 1);
  }

 private:
  std::mt19937 generator_{5489};
};

// Small triangles all over, and a few that reach across all of them.
TriangleMesh scattered(int count) {
  Random random;
  TriangleMesh mesh;
  for (int t = 0; t < count; ++t) {
    const Eigen::Vector3d at = random.point(10);
    const double reach = t % 50 == 0 ? 8.0 : 0.5;
    for (int k = 0; k < 3; ++k) mesh.vertices.push_back(at + random.point(reach));
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return mesh;
}

Corners corners(const TriangleMesh& mesh, int t) {
  const auto& [a, b, c] = mesh.triangles[t];
  return {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
}

TEST(BoxTree, BoxesInFloatsHoldTheirBoxes) {
  const Eigen::AlignedBox3d box(Eigen::Vector3d(0.1, -0.1, 1.0 / 3), Eigen::Vector3d(0.7, 0.3, 2.0 / 3));
  const Eigen::AlignedBox3f around = box_around(box);
  EXPECT_TRUE((around.min().cast<double>().array() <= box.min().array()).all());
  EXPECT_TRUE((around.max().cast<double>().array() >= box.max().array()).all());
  EXPECT_LT((around.sizes().cast<double>() - box.sizes()).norm(), 1e-6);
}

TEST(TriangleTree, NearestIsTheNearestOfAllTriangles) {
  const TriangleMesh mesh = scattered(500);
  const TriangleTree tree(mesh);
  Random random;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d p = random.point(15);
    double least = std::numeric_limits<double>::infinity();
    for (int t = 0; t < 500; ++t)
      least = std::min(least, (nearest_on_triangle(p, corners(mesh, t)) - p).norm());
    EXPECT_EQ(tree.distance_mm(p), least);
  }
}

TEST(TriangleTree, WithinIsTrueFromTheDistanceOnAndFalseBelowIt) {
  const TriangleMesh mesh = scattered(500);
  const TriangleTree tree(mesh);
  Random random;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d p = random.point(15);
    const double distance = tree.distance_mm(p);
    EXPECT_TRUE(tree.is_within(p, distance));
    EXPECT_TRUE(tree.is_within(p, 2.0 * distance));
    EXPECT_FALSE(tree.is_within(p, std::nextafter(distance, 0.0)));
    EXPECT_FALSE(tree.is_within(p, 0.5 * distance));
  }
}

TEST(TriangleTree, NearestPointOfATriangleIsNoFurtherThanAnyOtherOfIt) {
  const TriangleMesh mesh = scattered(100);
  Random random;
  for (int t = 0; t < 100; ++t) {
    const Corners c = corners(mesh, t);
    const Eigen::Vector3d p = random.point(12);
    const double distance = (nearest_on_triangle(p, c) - p).norm();
    for (int i = 0; i <= 20; ++i)
      for (int j = 0; j <= 20 - i; ++j)
        EXPECT_LE(distance, (c[0] + (c[1] - c[0]) * i / 20.0 + (c[2] - c[0]) * j / 20.0 - p).norm() + 1e-12);
  }
}

// Rays through corners and along sides: an octahedron asked from its middle and beside it.
TEST(TriangleTree, ARayThroughACornerLeavesOnce) {
  TriangleMesh mesh;
  mesh.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  const TriangleTree tree(mesh);
  for (const Eigen::Vector3d& corner : mesh.vertices)
    EXPECT_NEAR(tree.way_out(Eigen::Vector3d::Zero(), corner, 9), 1, 1e-15);
  const Eigen::Vector3d aside = Eigen::Vector3d(1, 1, 0).normalized();
  EXPECT_NEAR(tree.way_out(Eigen::Vector3d::Zero(), aside, 9), std::sqrt(0.5), 1e-15);
  EXPECT_EQ(tree.way_out(Eigen::Vector3d::Zero(), aside, 0.5), 0.5) << "nothing before that";
  EXPECT_EQ(tree.way_out({3, 0, 0}, Eigen::Vector3d(1, 0, 0), 9), 9)
      << "it enters nowhere, so it leaves nowhere";
  EXPECT_NEAR(tree.way_out({-3, 0, 0}, Eigen::Vector3d(1, 0, 0), 9), 4, 1e-15)
      << "through, out at the far side";
  const Eigen::Vector3d direction(0.3567, 0.7193, 0.5961);  // that is_inside() looks along
  for (const Eigen::Vector3d& corner : mesh.vertices) {
    const Eigen::Vector3d before = corner - 0.25 * direction;
    EXPECT_EQ(tree.is_inside(before), before.lpNorm<1>() < 1) << corner.transpose();
  }
}

TEST(TriangleTree, InsideOfASphereIsNearerThanItsRadius) {
  const TriangleTree tree(bodies::sphere(10.0, 4));
  Random random;
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3d from_middle = random.point(12), p = from_middle + Eigen::Vector3d(0, 0, 10);
    if (std::abs(from_middle.norm() - 9.95) < 0.05) continue;
    EXPECT_EQ(tree.is_inside(p), from_middle.norm() < 9.95) << p.transpose();
  }
}

}  // namespace
}  // namespace skinframe
