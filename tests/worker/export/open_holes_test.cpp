// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/export/open_holes.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "tests/worker/drain/hollow.h"
#include "worker/drain/cut_sheet.h"
#include "worker/export/crossings.h"
#include "worker/export/printable.h"
#include "worker/frame/vertex_graph.h"
#include "worker/skin/mend_edges.h"

namespace skinframe {
namespace {

double section(double radius) {
  return 0.5 * kPrismSides * radius * radius * std::sin(2.0 * std::numbers::pi / kPrismSides);
}

PrintableMesh merged(const hollow::Body& body) {
  RunContext context;
  auto result = merge_solid(body.mesh, body.skin, Frame{}, {}, {}, context);
  EXPECT_TRUE(result.ok()) << result.error().message;
  return std::move(result.value());
}

void expect_whole(const OpenedMesh& opened, const TriangleMesh& body) {
  EXPECT_EQ(count_bad_edges(opened.mesh), 0);
  EXPECT_TRUE(crossing_triangles(opened.mesh).empty());
  TriangleMesh outer = opened.lids;
  const int first = static_cast<int>(outer.vertices.size());
  outer.vertices.insert(outer.vertices.end(), opened.mesh.vertices.begin(), opened.mesh.vertices.end());
  for (std::size_t t = 0; t < opened.outer_triangles; ++t) {
    const auto& [a, b, c] = opened.mesh.triangles[t];
    outer.triangles.push_back({first + a, first + b, first + c});
  }
  EXPECT_NEAR(signed_volume(outer), signed_volume(body), 1e-6 * signed_volume(body));
}

TEST(OpenHoles, ABoxLosesTheSkinWithinAndStaysWatertight) {
  const hollow::Body box = hollow::make(bodies::box(56, 46, 12));
  const PrintableMesh whole = merged(box);
  const Eigen::Vector3d down = -Eigen::Vector3d::UnitZ();
  const std::vector<Opening> openings{{{15, 15, 0}, down, 8, 1, 3}, {{42, 33, 0}, down, 5, 1, 3}};
  ASSERT_EQ(find_sealed_voids(whole.mesh).size(), 1u);
  EXPECT_NEAR(find_sealed_voids(whole.mesh)[0].volume_mm3, whole.cavity_volume_mm3, 1e-3);
  const OpenedMesh opened = open_holes(whole.mesh, box.mesh.triangles.size(), openings);
  EXPECT_EQ(opened.openings.size(), 2u);
  EXPECT_TRUE(opened.uncut.empty());
  expect_whole(opened, box.mesh);
  EXPECT_NEAR(whole.volume_mm3 - opened.volume_mm3, section(8) + section(5), 1.0);
  EXPECT_TRUE(find_sealed_voids(opened.mesh).empty());
  EXPECT_EQ(split_pieces(opened.mesh).size(), 1u);
}

TEST(OpenHoles, ABallIsOpenedWhereItIsCurved) {
  const hollow::Body ball = hollow::make(bodies::sphere(20, 4));
  const Eigen::Vector3d axis = Eigen::Vector3d(0.3, -0.2, -1).normalized();
  const OpenedMesh opened = open_holes(merged(ball).mesh, ball.mesh.triangles.size(),
                                       {{Eigen::Vector3d(0, 0, 20) + 20 * axis, axis, 5, 1.5, 3}});
  EXPECT_EQ(opened.openings.size(), 1u);
  expect_whole(opened, ball.mesh);
  EXPECT_TRUE(find_sealed_voids(opened.mesh).empty());
}

TEST(OpenHoles, WhatAStrutStandsInStaysClosedAndIsNamed) {
  const hollow::Body box = hollow::make(bodies::box(56, 46, 12));
  Frame frame;
  frame.nodes_mm = {{30, 25, 1}, {30, 25, 11}};
  frame.skin_node_count = 2;
  frame.struts = {{0, 1, false}};
  RunContext context;
  const auto whole = merge_solid(box.mesh, box.skin, frame, {1.0}, {}, context);
  ASSERT_TRUE(whole.ok());
  const OpenedMesh opened =
      open_holes(whole->mesh, box.mesh.triangles.size(), {{{30, 25, 0}, -Eigen::Vector3d::UnitZ(), 8, 1, 3}});
  EXPECT_TRUE(opened.openings.empty());
  ASSERT_EQ(opened.uncut.size(), 1u);
  EXPECT_EQ(opened.mesh.triangles.size(), whole->mesh.triangles.size());
  EXPECT_EQ(find_sealed_voids(opened.mesh).size(), 1u);
}

TEST(MakeCaps, APlugOfTheSkinsThicknessFitsTheHoleWithItsClearance) {
  const hollow::Body ball = hollow::make(bodies::sphere(20, 4));
  const Eigen::Vector3d axis = Eigen::Vector3d(0, -0.2, -1).normalized();
  const Opening opening{Eigen::Vector3d(0, 0, 20) + 20 * axis, axis, 5, 1.5, 3};
  int capped = 0;
  const TriangleMesh caps = make_caps(ball.mesh, {opening}, 1.0, 0.25, &capped);
  EXPECT_EQ(capped, 1);
  EXPECT_EQ(count_bad_edges(caps), 0);
  EXPECT_TRUE(crossing_triangles(caps).empty());
  EXPECT_NEAR(signed_volume(caps), section(4.75), 0.01);
  double widest = 0.0;
  for (const Eigen::Vector3d& p : caps.vertices) {
    const Eigen::Vector3d from = p - opening.centre_mm;
    widest = std::max(widest, (from - from.dot(axis) * axis).norm());
  }
  EXPECT_NEAR(widest, 4.75, 1e-3);
}

}  // namespace
}  // namespace skinframe
