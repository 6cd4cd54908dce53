// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/export/printable.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "tests/worker/skin/bodies.h"
#include "worker/export/crossings.h"
#include "worker/frame/sample_frame.h"
#include "worker/mesh/read_mesh.h"
#include "worker/mesh/write_stl.h"
#include "worker/skin/mend_edges.h"
#include "worker/skin/triangle_tree.h"

namespace skinframe {
namespace {

constexpr double kPi = std::numbers::pi;

Skin skin_of(const TriangleMesh& body) {
  RunContext context;
  auto skin = build_skin(body, {.thickness_mm = 1.0}, context);
  EXPECT_TRUE(skin.ok()) << skin.error().message;
  return std::move(skin.value());
}

PrintableMesh merged(const TriangleMesh& body, const Skin& skin, const Frame& frame,
                     std::vector<double> radii, ExportOptions options = {}, int threads = 1) {
  RunContext context;
  context.threads = threads;
  auto result = merge_solid(body, skin, frame, radii, options, context);
  EXPECT_TRUE(result.ok()) << result.error().message;
  return std::move(result.value());
}

TriangleMesh written_and_read(const TriangleMesh& mesh) {
  const auto path = std::filesystem::path(testing::TempDir()) / "skinframe_printable_test.stl";
  EXPECT_TRUE(write_stl(mesh, path).ok());
  RunContext context;
  auto file = read_mesh(path, {}, context);
  EXPECT_TRUE(file.ok());
  std::filesystem::remove(path);
  return std::move(file.value().mesh);
}

// One strut of radius 1 from wall to wall of a box of 30 x 20 x 20: inside M1 it is a cylinder of 28 mm.
Frame strut_across_the_box() {
  Frame frame;
  frame.nodes_mm = {{1, 10, 10}, {29, 10, 10}};
  frame.skin_node_count = 2;
  frame.struts = {{0, 1, false}};
  return frame;
}

TEST(MergeSolid, IsSkinAndStrutAndNothingElse) {
  const TriangleMesh body = bodies::box(30, 20, 20);
  const Skin skin = skin_of(body);
  const PrintableMesh printable = merged(body, skin, strut_across_the_box(), {1.0}, {.voxel_mm = 0.3});
  const double strut = kPi * 28.0, shell = 30.0 * 20.0 * 20.0 - 28.0 * 18.0 * 18.0;
  EXPECT_NEAR(skin.cavity_volume_mm3 - printable.cavity_volume_mm3, strut, 0.05 * strut);
  EXPECT_NEAR(printable.volume_mm3, shell + strut, 0.01 * (shell + strut));
  EXPECT_NEAR(signed_volume(printable.mesh), printable.volume_mm3, 1e-3);
  EXPECT_EQ(printable.pockets, 1);
}

TEST(MergeSolid, IsClosedAndManifoldWhenReadBackFromStl) {
  const TriangleMesh body = bodies::box(30, 20, 20);
  const Skin skin = skin_of(body);
  const PrintableMesh printable = merged(body, skin, strut_across_the_box(), {1.0});
  EXPECT_EQ(count_bad_edges(printable.mesh), 0);
  const TriangleMesh back = written_and_read(printable.mesh);
  EXPECT_EQ(back.triangles.size(), printable.mesh.triangles.size());
  EXPECT_EQ(count_bad_edges(back), 0);
  EXPECT_NEAR(signed_volume(back), printable.volume_mm3, 1e-3);
}

TEST(MergeSolid, KeepsTheTrianglesOfTheInputFirstAndUntouched) {
  const TriangleMesh body = bodies::box(30, 20, 20);
  const PrintableMesh printable = merged(body, skin_of(body), strut_across_the_box(), {1.0});
  ASSERT_GT(printable.mesh.triangles.size(), body.triangles.size());
  EXPECT_TRUE(std::equal(body.triangles.begin(), body.triangles.end(), printable.mesh.triangles.begin()));
  EXPECT_TRUE(std::equal(body.vertices.begin(), body.vertices.end(), printable.mesh.vertices.begin()));
}

TEST(MergeSolid, NeverMakesTheWallThinnerThanTheSkin) {
  const TriangleMesh body = bodies::torus(20, 8);
  const Skin skin = skin_of(body);
  RunContext context;
  FrameOptions options;
  options.plate.tensile_modulus_mpa = 1586;
  options.internal_nodes = 20;
  const auto sampled = sample_frame(skin, options, context);
  ASSERT_TRUE(sampled.ok()) << sampled.error().message;
  const PrintableMesh printable =
      merged(body, skin, sampled->frame, std::vector<double>(sampled->frame.struts.size(), 0.5));
  double shallowest = -1e9;
  for (std::size_t i = body.vertices.size(); i < printable.mesh.vertices.size(); ++i) {
    shallowest = std::max(shallowest, skin.field.at(printable.mesh.vertices[i]));
  }
  EXPECT_LT(shallowest, -0.9);
  EXPECT_EQ(count_bad_edges(written_and_read(printable.mesh)), 0);
  EXPECT_LT(printable.volume_mm3, signed_volume(body));
  EXPECT_GT(printable.volume_mm3, skin.volume_mm3);
}

TEST(MergeSolid, StrutThickerThanTheHollowFillsIt) {
  const TriangleMesh body = bodies::box(20, 10, 10);
  const Skin skin = skin_of(body);
  Frame frame;
  frame.nodes_mm = {{5, 5, 5}, {15, 5, 5}};
  frame.struts = {{0, 1, false}};
  const PrintableMesh printable = merged(body, skin, frame, {30.0}, {.voxel_mm = 0.5});
  EXPECT_EQ(printable.pockets, 0);
  EXPECT_EQ(printable.mesh.triangles.size(), body.triangles.size());
  EXPECT_NEAR(printable.volume_mm3, 2000.0, 1e-6);
}

TEST(MergeSolid, FillsPocketsBelowTheLimitAndOnlyThose) {
  const TriangleMesh body = bodies::box(20, 10, 10);
  const Skin skin = skin_of(body);
  Frame frame;  // a thick strut across the middle leaves the hollow's two ends, of unequal size
  frame.nodes_mm = {{9, 5, 5}, {9, 5, 5.5}};
  frame.struts = {{0, 1, false}};
  const double radius = 7.0;
  const PrintableMesh both =
      merged(body, skin, frame, {radius}, {.voxel_mm = 0.3, .smallest_pocket_mm3 = 1.0});
  ASSERT_EQ(both.pockets, 2);
  EXPECT_EQ(both.pockets_filled, 0);
  const double larger = 0.75 * both.cavity_volume_mm3;
  const PrintableMesh none =
      merged(body, skin, frame, {radius}, {.voxel_mm = 0.3, .smallest_pocket_mm3 = larger});
  EXPECT_EQ(none.pockets + none.pockets_filled, 2);
  EXPECT_GE(none.pockets_filled, 1);
}

// A strut that comes up to the skin's inside at a small angle leaves a gap from nothing to a voxel and more.
TEST(MergeSolid, AStrutCloseBelowTheSkinIsRoundAndCutsNothing) {
  const TriangleMesh body = bodies::box(60, 20, 20);
  Frame frame;
  frame.nodes_mm = {{5, 10, 18.5}, {55, 10, 18.0}, {5, 4, 18.45}, {55, 9, 18.4}};
  frame.struts = {{0, 1, false}, {2, 3, false}};
  const PrintableMesh printable = merged(body, skin_of(body), frame, {0.5, 0.5}, {.max_triangles = 4000});
  EXPECT_EQ(printable.crossings_left, 0);
  EXPECT_TRUE(crossing_triangles(printable.mesh).empty());
  TriangleMesh cavity = printable.mesh;
  cavity.triangles.erase(cavity.triangles.begin(), cavity.triangles.begin() + body.triangles.size());
  const TriangleTree hollow(cavity);
  for (const auto& strut : frame.struts) {
    const Eigen::Vector3d &a = frame.nodes_mm[strut.a], &b = frame.nodes_mm[strut.b];
    for (double t = 0.05; t < 0.96; t += 0.05)
      EXPECT_GT(hollow.distance_mm(a + t * (b - a)), 0.5 - 0.5 * printable.voxel_mm) << t;
  }
}

TEST(MergeSolid, SameAtAnyThreadCount) {
  const TriangleMesh body = bodies::box(30, 20, 20);
  const Skin skin = skin_of(body);
  const PrintableMesh one = merged(body, skin, strut_across_the_box(), {1.0}, {}, 1);
  const PrintableMesh two = merged(body, skin, strut_across_the_box(), {1.0}, {}, 2);
  EXPECT_EQ(one.mesh.vertices, two.mesh.vertices);
  EXPECT_EQ(one.mesh.triangles, two.mesh.triangles);
}

TEST(MergeSolid, RefusesAGridOutOfRangeByName) {
  const TriangleMesh body = bodies::box(10, 10, 10);
  const Skin skin = skin_of(body);
  RunContext context;
  for (double voxel : {-1.0, 1e-4, 5.0}) {
    const auto result = merge_solid(body, skin, Frame{}, {}, {.voxel_mm = voxel}, context);
    ASSERT_FALSE(result.ok());
    EXPECT_EQ(result.error().kind, ErrorKind::kInvalidInput);
    EXPECT_THAT(result.error().message, testing::HasSubstr("--voxel"));
  }
}

}  // namespace
}  // namespace skinframe
