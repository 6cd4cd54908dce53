// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/stress/lattice.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <numbers>

namespace skinframe {
namespace {

double ball(const Eigen::Vector3d& p) { return p.norm() - 10.0; }
double ring(const Eigen::Vector3d& p) { return std::hypot(std::hypot(p.x(), p.y()) - 12.0, p.z()) - 5.0; }
BoundingBox cube(double half) { return {Eigen::Vector3d::Constant(-half), Eigen::Vector3d::Constant(half)}; }

double least_dihedral_degrees(const TetMesh& mesh) {
  double least = 180.0;
  for (const auto& tet : mesh.tets)
    for (int i = 0; i < 4; ++i)
      for (int j = i + 1; j < 4; ++j) {
        int rest[2], n = 0;
        for (int k = 0; k < 4; ++k)
          if (k != i && k != j) rest[n++] = k;
        const Eigen::Vector3d& a = mesh.vertices_mm[tet[i]];
        const Eigen::Vector3d axis = (mesh.vertices_mm[tet[j]] - a).normalized();
        const auto across = [&](int k) {
          const Eigen::Vector3d v = mesh.vertices_mm[tet[k]] - a;
          return Eigen::Vector3d(v - v.dot(axis) * axis);
        };
        const Eigen::Vector3d u = across(rest[0]), v = across(rest[1]);
        least = std::min(least, std::atan2(u.cross(v).norm(), u.dot(v)) * 180.0 / std::numbers::pi);
      }
  return least;
}

TEST(Lattice, BallIsFilledToItsSurfaceByTetrahedraWithoutSlivers) {
  const auto mesh = fill_with_tetrahedra(ball, cube(10), 1.7, RunContext{});
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  EXPECT_NEAR(volume_mm3(*mesh), 4.0 / 3.0 * std::numbers::pi * 1000.0, 0.02 * 4189.0);
  for (const auto& face : boundary_of(*mesh))
    for (const int v : face) EXPECT_NEAR(mesh->vertices_mm[v].norm(), 10.0, 0.002);
  EXPECT_GT(least_dihedral_degrees(*mesh), 8.0);
}

void expect_closed_and_filled(const TetMesh& mesh) {
  std::map<std::pair<int, int>, int> directed;
  for (const auto& face : boundary_of(mesh))
    for (int k = 0; k < 3; ++k) ++directed[{face[k], face[(k + 1) % 3]}];
  for (const auto& [edge, count] : directed) {
    const auto twin = directed.find({edge.second, edge.first});
    ASSERT_NE(twin, directed.end());
    EXPECT_EQ(twin->second, count);
  }
  // Outward: the boundary encloses what the tetrahedra fill.
  double enclosed = 0.0;
  for (const auto& f : boundary_of(mesh))
    enclosed += mesh.vertices_mm[f[0]].cross(mesh.vertices_mm[f[1]]).dot(mesh.vertices_mm[f[2]]) / 6.0;
  EXPECT_NEAR(enclosed, volume_mm3(mesh), 1e-9 * enclosed);
  for (const int c : face_components(mesh)) EXPECT_EQ(c, 0);
}

TEST(Lattice, EveryInnerFaceHasTwoTetrahedraAndTheBoundaryIsClosed) {
  const auto mesh = fill_with_tetrahedra(ring, cube(17), 1.9, RunContext{});
  ASSERT_TRUE(mesh.ok());
  expect_closed_and_filled(*mesh);
}

TEST(Lattice, GradedItIsFineWhereAskedAndStillClosedWithoutSlivers) {
  const Eigen::Vector3d fine_at(0, 0, -10);
  const auto asked = [&](const Eigen::Vector3d& p) { return 0.4 + 0.5 * (p - fine_at).norm(); };
  const auto mesh = fill_with_graded_tetrahedra(ball, cube(10), 4, asked, RunContext{});
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  expect_closed_and_filled(*mesh);
  EXPECT_GT(least_dihedral_degrees(*mesh), 3.0);
  const auto plain = fill_with_tetrahedra(ball, cube(10), 4, RunContext{});
  EXPECT_LT(mesh->tets.size(), 12 * plain->tets.size());
  int near = 0;
  for (const auto& tet : mesh->tets) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const int v : tet) middle += mesh->vertices_mm[v] / 4;
    double longest = 0;
    for (const int a : tet)
      for (const int b : tet)
        longest = std::max(longest, (mesh->vertices_mm[a] - mesh->vertices_mm[b]).norm());
    EXPECT_LT(longest, 1.8 * asked(middle));  // points are pulled
    near += (middle - fine_at).norm() < 1;
  }
  EXPECT_GT(near, 30);
}

TEST(Lattice, GradedLikeTheLatticeItselfWhereNothingFinerIsAsked) {
  const auto plain = fill_with_tetrahedra(ring, cube(17), 2.4, RunContext{});
  const auto graded = fill_with_graded_tetrahedra(
      ring, cube(17), 2.4, [](const auto&) { return 2.41; }, RunContext{});
  ASSERT_TRUE(plain.ok() && graded.ok());
  EXPECT_NEAR(volume_mm3(*graded) / volume_mm3(*plain), 1, 0.003);
  EXPECT_NEAR(static_cast<double>(graded->tets.size()) / static_cast<double>(plain->tets.size()), 1, 0.2);
}

TEST(Lattice, TwoBallsAreTwoComponents) {
  const auto two = [](const Eigen::Vector3d& p) {
    return std::min((p - Eigen::Vector3d(6, 0, 0)).norm(), (p + Eigen::Vector3d(6, 0, 0)).norm()) - 4.0;
  };
  const auto mesh = fill_with_tetrahedra(two, cube(10), 1.1, RunContext{});
  ASSERT_TRUE(mesh.ok());
  const auto component = face_components(*mesh);
  EXPECT_EQ(*std::max_element(component.begin(), component.end()), 1);
}

TEST(Lattice, TooManyCellsAreRefusedBeforeMemoryIsTaken) {
  const auto refused = fill_with_tetrahedra(ball, cube(1e4), 0.01, RunContext{});
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().kind, ErrorKind::kInvalidInput);
  const auto as_fine = [](const auto&) { return 0.01; };
  EXPECT_FALSE(fill_with_graded_tetrahedra(ball, cube(10), 0.9 * least_spacing_mm(cube(10), kMostGradedCells),
                                           as_fine, RunContext{})
                   .ok());
  EXPECT_TRUE(fill_with_tetrahedra(ball, cube(10), least_spacing_mm(cube(10)) * 3, RunContext{}).ok());
}

}  // namespace
}  // namespace skinframe
