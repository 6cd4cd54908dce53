// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/support/support_mesh.h"

#include <gtest/gtest.h>

#include <map>

#include "tests/worker/support/small_prints.h"

namespace skinframe {
namespace {

using On = SupportNode::On;

// One upright from a node of the frame to a foot below it.
struct Upright {
  Frame frame;
  SupportPlan plan;
  Upright(double top, double foot, On on, SupportKind kind) {
    frame.nodes_mm = {{0, 0, top}};
    plan.nodes = {{{0, 0, foot}, on, -1}};
    plan.struts = {{0, 1, kind, 1.0}};
  }
};

void expect_closed(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> directed;
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) ++directed[{t[k], t[(k + 1) % 3]}];
  for (const auto& [edge, uses] : directed) {
    EXPECT_EQ(uses, 1);
    EXPECT_EQ(directed.count({edge.second, edge.first}), 1u);
  }
}

TEST(SupportMesh, AnInternalStrutIsAPrismBetweenItsNodes) {
  const Upright upright(20, 0.5, On::kSkin, SupportKind::kInternal);
  const auto mesh = support_mesh(upright.frame, upright.plan, SupportKind::kInternal, test::hall(), Neck{});
  expect_closed(mesh);
  EXPECT_NEAR(signed_volume(mesh), 3.0 * 19.5, 1e-4) << "a polygon of 12 sides has the area 3 r^2";
  EXPECT_TRUE(support_mesh(upright.frame, upright.plan, SupportKind::kExternal, test::hall(), Neck{})
                  .triangles.empty());
}

TEST(SupportMesh, AnExternalStrutHangsOnItsNeckAndStandsOnThePlate) {
  const Upright upright(31, 0, On::kPlate, SupportKind::kExternal);
  const Neck neck{0.2, 0.8};
  const auto mesh =
      support_mesh(upright.frame, upright.plan, SupportKind::kExternal, test::table_top(), neck);
  expect_closed(mesh);
  const BoundingBox box = bounding_box(mesh);
  EXPECT_EQ(box.min.z(), 0.0);
  EXPECT_NEAR(box.max.z(), 30.25, 0.07) << "a quarter of the skin into the underside at 30 mm";
  for (const Eigen::Vector3d& v : mesh.vertices) {
    if (v.z() > 29.9) {
      EXPECT_NEAR(v.head<2>().norm(), 0.2, 1e-5);
    }
    if (v.z() < 29.0) {
      EXPECT_NEAR(v.head<2>().norm(), 1.0, 1e-5);
    }
  }
}

}  // namespace
}  // namespace skinframe
