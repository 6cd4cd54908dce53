// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/export/compact_mesh.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/worker/skin/bodies.h"
#include "worker/export/crossings.h"
#include "worker/skin/mend_edges.h"

namespace skinframe {
namespace {

// A ball of 20 mm with a ball of 15 mm taken out of it.
PrintableMesh hollow_ball() {
  PrintableMesh printable;
  printable.mesh = bodies::sphere(20, 5);
  const TriangleMesh inner = bodies::sphere(15, 5);
  const int first = static_cast<int>(printable.mesh.vertices.size());
  for (const auto& v : inner.vertices) printable.mesh.vertices.push_back(v + Eigen::Vector3d(0, 0, 5));
  for (const auto& t : inner.triangles)
    printable.mesh.triangles.push_back({first + t[0], first + t[2], first + t[1]});
  for (auto& v : printable.mesh.vertices) v = v.cast<float>().cast<double>();
  return printable;
}

TEST(CompactMesh, HasTheTrianglesWantedAndStaysClosedAndNear) {
  const PrintableMesh full = hollow_ball();
  const std::size_t outer = full.mesh.triangles.size() / 2;
  const auto compact = make_compact(full, outer, {.triangles = 12000, .max_deviation_mm = 0.2}, RunContext{});
  ASSERT_TRUE(compact.ok());
  EXPECT_LE(compact->mesh.triangles.size(), 12000u);
  EXPECT_EQ(count_bad_edges(compact->mesh), 0);
  EXPECT_TRUE(crossing_triangles(compact->mesh).empty());
  EXPECT_GT(compact->deviation_mm, 0.0);
  EXPECT_LE(compact->deviation_mm, 0.2);
  EXPECT_NEAR(compact->volume_mm3, signed_volume(full.mesh), 0.02 * signed_volume(full.mesh));
  EXPECT_DOUBLE_EQ(compact->volume_mm3, signed_volume(compact->mesh));
}

TEST(CompactMesh, TheDeviationComesBeforeTheTriangleCount) {
  const PrintableMesh full = hollow_ball();
  const auto compact = make_compact(full, full.mesh.triangles.size() / 2,
                                    {.triangles = 100, .max_deviation_mm = 0.02}, RunContext{});
  ASSERT_TRUE(compact.ok());
  EXPECT_LE(compact->deviation_mm, 0.02);
  EXPECT_GT(compact->mesh.triangles.size(), 100u);
}

TEST(CompactMesh, CornersOfTheOuterSurfaceGoButNeverMove) {
  const PrintableMesh full = hollow_ball();
  const std::size_t outer = full.mesh.triangles.size() / 2;
  const auto compact = make_compact(full, outer, {.triangles = 8000, .max_deviation_mm = 0.2}, RunContext{});
  ASSERT_TRUE(compact.ok());
  EXPECT_LT(compact->outer_triangles, outer);
  std::set<std::array<double, 3>> corners;
  for (const auto& v : full.mesh.vertices) corners.insert({v.x(), v.y(), v.z()});
  for (std::size_t t = 0; t < compact->outer_triangles; ++t) {
    for (int i : compact->mesh.triangles[t]) {
      const auto& v = compact->mesh.vertices[i];
      ASSERT_TRUE(corners.contains({v.x(), v.y(), v.z()}));
    }
  }
}

TEST(CompactMesh, IsTheSameAtAnyNumberOfThreads) {
  const PrintableMesh full = hollow_ball();
  RunContext one, two;
  two.threads = 2;
  const CompactOptions options{.triangles = 9000, .max_deviation_mm = 0.2};
  const auto a = make_compact(full, full.mesh.triangles.size() / 2, options, one);
  const auto b = make_compact(full, full.mesh.triangles.size() / 2, options, two);
  ASSERT_TRUE(a.ok() && b.ok());
  EXPECT_EQ(a->mesh.triangles, b->mesh.triangles);
  EXPECT_EQ(a->mesh.vertices, b->mesh.vertices);
}

TEST(CompactMesh, AFewTrianglesStayAsTheyAre) {
  PrintableMesh box;
  box.mesh = bodies::box(10, 10, 10);
  const auto compact = make_compact(box, box.mesh.triangles.size(), {}, RunContext{});
  ASSERT_TRUE(compact.ok());
  EXPECT_EQ(compact->mesh.triangles, box.mesh.triangles);
  EXPECT_EQ(compact->deviation_mm, 0.0);
}

}  // namespace
}  // namespace skinframe
