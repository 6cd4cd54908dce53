// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/drain/cut_sheet.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "tests/worker/skin/bodies.h"

namespace skinframe {
namespace {

double area_along(const std::vector<std::array<int, 3>>& triangles, const TriangleMesh& mesh,
                  const Eigen::Vector3d& axis) {
  double area = 0.0;
  for (const auto& [a, b, c] : triangles)
    area += 0.5 * (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).dot(axis);
  return area;
}

// Of the prism's section.
double section(double radius) {
  return 0.5 * kPrismSides * radius * radius * std::sin(2.0 * std::numbers::pi / kPrismSides);
}

void expect_cut(const TriangleMesh& body, const Opening& opening) {
  const auto cut = cut_sheet(body, opening, 0.0);
  ASSERT_TRUE(cut.has_value());
  TriangleMesh opened = body;
  remove_lid(opened, *cut);
  EXPECT_NEAR(area_along(cut->lid, opened, opening.axis), section(opening.radius_mm), 1e-4);
  // Lid and rest are the body again.
  TriangleMesh whole = opened;
  whole.triangles.insert(whole.triangles.end(), cut->lid.begin(), cut->lid.end());
  EXPECT_NEAR(signed_volume(whole), signed_volume(body), 1e-3);
  EXPECT_NEAR(surface_area(whole), surface_area(body), 1e-3);
  for (const Eigen::Vector3d& p : cut->added) EXPECT_EQ(p, p.cast<float>().cast<double>());
  ASSERT_EQ(cut->loop.size(), cut->angles.size());
  EXPECT_GE(cut->loop.size(), static_cast<std::size_t>(kPrismSides));
  for (std::size_t i = 0; i < cut->loop.size(); ++i) {
    const Eigen::Vector3d from = opened.vertices[cut->loop[i]] - opening.centre_mm;
    const double beside = (from - from.dot(opening.axis) * opening.axis).norm();
    EXPECT_LE(beside, opening.radius_mm + 1e-4);
    EXPECT_GE(beside, opening.radius_mm * std::cos(std::numbers::pi / kPrismSides) - 1e-4);
    if (i > 0) {
      EXPECT_GT(cut->angles[i], cut->angles[i - 1]);
    }
  }
}

TEST(CutSheet, OpensTheMiddleOfALargeTriangle) {
  expect_cut(bodies::box(60, 50, 40), {{35, 20, 0}, -Eigen::Vector3d::UnitZ(), 5, 1, 3});
}

TEST(CutSheet, OpensAcrossTheDiagonalOfAFace) {
  expect_cut(bodies::box(60, 50, 40), {{30, 25, 0}, -Eigen::Vector3d::UnitZ(), 10, 1, 3});
}

TEST(CutSheet, OpensACurvedSurfaceOfManyTriangles) {
  const Eigen::Vector3d axis = Eigen::Vector3d(0.3, -0.2, -1).normalized();
  expect_cut(bodies::sphere(40), {Eigen::Vector3d(0, 0, 40) + 40 * axis, axis, 10, 1.5, 5});
}

TEST(CutSheet, RefusesWhatIsNoSingleDisc) {
  const TriangleMesh box = bodies::box(60, 50, 4);
  const Eigen::Vector3d down = -Eigen::Vector3d::UnitZ();
  EXPECT_FALSE(cut_sheet(box, {{2, 20, 0}, down, 5, 1, 3}, 0.0)) << "over the edge of the face";
  EXPECT_FALSE(cut_sheet(box, {{30, 20, 0}, down, 5, 1, 5}, 0.0)) << "through both faces";
  EXPECT_FALSE(cut_sheet(box, {{30, 20, -20}, down, 5, 1, 3}, 0.0)) << "beside the body";
  EXPECT_FALSE(cut_sheet(box, {{30, 20, 4}, down, 5, 1, 3}, 0.0)) << "a face that looks the other way";
}

}  // namespace
}  // namespace skinframe
