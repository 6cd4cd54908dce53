// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/mesh/triangulate_polygon.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <numeric>

#include "worker/mesh/triangle_mesh.h"

namespace skinframe {
namespace {

using Outline = std::vector<Eigen::Vector3d>;

TriangleMesh cut(const Outline& outline, bool* clean = nullptr) {
  std::vector<int> corners(outline.size());
  std::iota(corners.begin(), corners.end(), 0);
  TriangleMesh mesh{outline, {}};
  std::uint64_t steps = 1'000'000;
  const Triangulation result = triangulate_polygon(corners, mesh.vertices, mesh.triangles, &steps);
  if (clean != nullptr) *clean = result == Triangulation::kClean;
  return mesh;
}

// Newell's sum: what the triangles of any correct triangulation add up to as vectors.
Eigen::Vector3d vector_area(const TriangleMesh& mesh) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& [a, b, c] : mesh.triangles) {
    sum += (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]) / 2;
  }
  return sum;
}

// Triangles of a concave outline that overlap or stick out have more area than their vector sum.
void expect_exact_cover(const Outline& outline, double area) {
  bool clean = false;
  const TriangleMesh mesh = cut(outline, &clean);
  EXPECT_TRUE(clean);
  EXPECT_EQ(mesh.triangles.size(), outline.size() - 2);
  EXPECT_NEAR(surface_area(mesh), area, 1e-12 * area);
  EXPECT_NEAR(vector_area(mesh).norm(), area, 1e-12 * area);
}

TEST(TriangulatePolygon, ArrowheadKeepsItsNotch) {
  expect_exact_cover({{0, 0, 0}, {2, 1, 0}, {0, 2, 0}, {1, 1, 0}}, 1);
  expect_exact_cover({{2, 1, 0}, {0, 2, 0}, {1, 1, 0}, {0, 0, 0}}, 1);  // whichever corner comes first
}

TEST(TriangulatePolygon, CombAndStarAreCoveredExactlyInAnyPlane) {
  Outline comb{{0, 0, 0}};
  for (int tooth = 0; tooth < 8; ++tooth) {
    comb.emplace_back(2.0 * tooth + 1, 0, 0.3 * (2.0 * tooth + 1));
    comb.emplace_back(2.0 * tooth + 1, 5, 0.3 * (2.0 * tooth + 1));
    comb.emplace_back(2.0 * tooth + 2, 5, 0.3 * (2.0 * tooth + 2));
    comb.emplace_back(2.0 * tooth + 2, 0, 0.3 * (2.0 * tooth + 2));
  }
  comb.emplace_back(16, -1, 0.3 * 16);
  comb.emplace_back(0, -1, 0);
  expect_exact_cover(comb, (16 + 8 * 5) * std::hypot(1.0, 0.3));
  Outline star;
  for (int i = 0; i < 20; ++i) {
    const double r = i % 2 == 0 ? 2 : 1, angle = i * std::numbers::pi / 10;
    star.emplace_back(3, r * std::cos(angle), r * std::sin(angle));
  }
  expect_exact_cover(star, 20 * std::sin(std::numbers::pi / 10));
}

TEST(TriangulatePolygon, TheSlitToAHoleIsNoObstacle) {
  // Outer square, slit, inner square the other way round, slit back.
  const Outline outline{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0},
                        {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}};
  expect_exact_cover(outline, 12);
}

TEST(TriangulatePolygon, AnOutlineWithoutAreaStillGivesCornersMinusTwo) {
  bool clean = true;
  EXPECT_EQ(cut({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}}, &clean).triangles.size(), 3u);
  EXPECT_FALSE(clean);
  EXPECT_TRUE(cut({{0, 0, 0}, {1, 0, 0}}).triangles.empty());
}

}  // namespace
}  // namespace skinframe
