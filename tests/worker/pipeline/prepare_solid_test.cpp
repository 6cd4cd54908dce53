// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/pipeline/prepare_solid.h"

#include <gmock/gmock.h>

#include "tests/worker/pipeline/small_job.h"
#include "tests/worker/solid/shapes.h"

namespace skinframe {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

Result<PreparedSolid> prepare(const TriangleMesh& mesh, std::optional<double> size_mm) {
  test::TemporaryFolder folder;
  JobRequest request;
  request.mesh_name = "body.stl";
  request.mesh_path = folder.path() / request.mesh_name;
  SKINFRAME_CHECK(write_stl(mesh, request.mesh_path).ok());
  request.options.size_mm = size_mm;
  RunContext context;
  return prepare_solid(request, context);
}

TEST(PrepareSolid, ASpeckThatRepairDropsDoesNotMakeTheBodySmaller) {
  // An open speck far away: without it the body has a fifth of the box.
  TriangleMesh mesh = testing::cube(20);
  mesh = testing::merged(mesh, {{{100, 0, -5}, {100.01, 0, -5}, {100, 0.01, -5}}, {{0, 1, 2}}});
  const auto prepared = prepare(mesh, 50.0);
  ASSERT_TRUE(prepared.ok()) << prepared.error().message;
  EXPECT_NEAR(prepared->solid.volume_mm3(), 50 * 50 * 50, 1);
  EXPECT_NEAR(prepared->solid.box().min.z(), 0, 1e-4);
  EXPECT_THAT(prepared->facts.repairs, Contains("dropped 1 loose scrap"));
  EXPECT_THAT(prepared->facts.repairs, Contains(HasSubstr("scaled what is left by 5")));
}

TEST(PrepareSolid, RepairsAreReportedWithTheirVolumes) {
  const auto prepared = prepare(
      testing::merged(testing::cube(20), testing::moved(testing::cube(20), {10, 9, 8})), std::nullopt);
  ASSERT_TRUE(prepared.ok()) << prepared.error().message;
  EXPECT_THAT(prepared->facts.repairs, Contains(HasSubstr("add up to 16000 mm3 and enclose 14680 mm3")));
}

TEST(PrepareSolid, OrientBestPutsTheBodyDownWhereItNeedsLeast) {
  // A plate on a stem, 50 mm high: upside down the plate lies on the base plane.
  test::TemporaryFolder folder;
  JobRequest request;
  request.mesh_name = "table.stl";
  request.mesh_path = folder.path() / request.mesh_name;
  TriangleMesh plate = testing::cube(20);
  for (Eigen::Vector3d& v : plate.vertices) v = {3 * v.x(), 3 * v.y(), 0.5 * v.z()};
  TriangleMesh stem = testing::cube(20);
  for (Eigen::Vector3d& v : stem.vertices) v.z() *= 2;
  const double middle = 0.5 * (bounding_box(stem).min.x() + bounding_box(stem).max.x());
  const double wide = 0.5 * (bounding_box(plate).min.x() + bounding_box(plate).max.x());
  const double over = bounding_box(stem).max.z() - bounding_box(plate).min.z() - 1.0;
  const TriangleMesh mesh =
      testing::merged(stem, testing::moved(plate, {middle - wide, middle - wide, over}));
  SKINFRAME_CHECK(write_stl(mesh, request.mesh_path).ok());
  request.options.orient = Orient::kBest;
  RunContext context;
  request.printers = {test::sinterstation_pa()};
  const auto kept = prepare_solid(request, context);
  ASSERT_TRUE(kept.ok()) << kept.error().message;
  EXPECT_GT(kept->solid.centroid_mm().z(), 0.5 * kept->solid.box().max.z()) << "powder needs no supports";
  EXPECT_FALSE(kept->facts.orientation->chosen.has_value());

  request.printers = {test::makerbot_pla()};
  const auto turned = prepare_solid(request, context);
  ASSERT_TRUE(turned.ok()) << turned.error().message;
  EXPECT_NEAR(turned->solid.box().min.z(), 0, 1e-4);
  EXPECT_NEAR(turned->solid.volume_mm3(), kept->solid.volume_mm3(), 1);
  const OrientationFacts& facts = *turned->facts.orientation;
  ASSERT_TRUE(facts.chosen && facts.runner_up);
  EXPECT_FALSE(facts.chosen->rotation.isIdentity(1e-3)) << "as the file has it the plate hangs over";
  EXPECT_TRUE(turned->contact.stands);
  EXPECT_LE(facts.chosen->support_estimate_mm3, facts.runner_up->support_estimate_mm3);
}

TEST(PrepareSolid, AMistakeOfUnitIsNamed) {
  const auto prepared = prepare(testing::cube(0.02), std::nullopt);
  ASSERT_FALSE(prepared.ok());
  EXPECT_THAT(prepared.error().message, HasSubstr("--size"));
}

}  // namespace
}  // namespace skinframe
