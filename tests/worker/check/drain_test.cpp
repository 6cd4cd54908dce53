// SPDX-License-Identifier: GPL-3.0-or-later
// Drain holes: the check says yes to a result as it was made, and no to each lie told about it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <functional>

#include "tests/worker/pipeline/small_job.h"
#include "tests/worker/skin/bodies.h"
#include "worker/check/check.h"
#include "worker/check/claims.h"
#include "worker/check/exported.h"
#include "worker/check/surface.h"
#include "worker/check/void_columns.h"

namespace skinframe::check {
namespace {

namespace fs = std::filesystem;

TriangleMesh hollow_box(bool with_a_hole) {
  // Cells of 2 mm, 10 on a side, one thick; the hole is a cell of the wall below.
  return bodies::blocks({10, 10, 10}, {2, 2, 2}, [&](int x, int y, int z) {
    const bool wall = x == 0 || x == 9 || y == 0 || y == 9 || z == 0 || z == 9;
    return wall && !(with_a_hole && x == 4 && y == 5 && z == 0);
  });
}

TEST(FloodVoid, AClosedHollowHasNoWayOutAndAnOpenOneHas) {
  const VoidVolumes closed = flood_void(hollow_box(false), 0.9);
  EXPECT_NEAR(closed.sealed_mm3, 16 * 16 * 16, 0.1 * 16 * 16 * 16);  // by columns of 0.9 mm
  EXPECT_EQ(closed.reached_mm3, 0);
  const VoidVolumes open = flood_void(hollow_box(true), 0.9);
  EXPECT_EQ(open.sealed_mm3, 0);
  EXPECT_GT(open.reached_mm3, 0.8 * 16 * 16 * 16);
  EXPECT_EQ(open.torn, 0u);
}

TEST(FloodVoid, APassageBetweenColumnsIsFoundByNarrowerOnes) {
  // The hole is 2 mm wide; columns 3 mm apart have the walls among them, and miss it.
  const VoidVolumes wide = flood_void(hollow_box(true), 3.0);
  ASSERT_EQ(wide.sealed.size(), 1u);
  EXPECT_NEAR((wide.sealed[0].centre_mm - Eigen::Vector3d(10, 10, 10)).norm(), 0, 2.0);
  EXPECT_EQ(flood_void(hollow_box(true), 1.8).sealed_mm3, 0);
}

class DrainCheck : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new test::TemporaryFolder;
    JobRequest request = test::sample_job("egg", 36, 60, folder_->path());
    request.printers[0].printer.drain_holes = DrainHoleRule{6, 2, 6};
    request.printers[0].printer.min_radius_mm = 0.8;  // a coarser grid than the printer's 0.5
    request.options.no_optimize = true;
    RunContext context;
    auto outcomes = run_pipeline(request, honest(), PipelineObserver{}, context);
    ASSERT_TRUE(outcomes.ok()) << outcomes.error().message;
    ASSERT_TRUE(outcomes->front().succeeded()) << outcomes->front().detail;
    auto exported = read_exported(honest(), context);
    ASSERT_TRUE(exported.ok()) << exported.error().message;
    ASSERT_EQ(exported->printers.size(), 1u);
    exported_ = new ExportedPrinter(exported->printers.front());
    ASSERT_TRUE(exported_->drain && exported_->drain->holes.size() == 2);
  }
  static void TearDownTestSuite() {
    delete exported_;
    delete folder_;
    exported_ = nullptr;
    folder_ = nullptr;
  }
  static fs::path honest() { return folder_->path() / "honest"; }
  static std::vector<std::string> denied(const Verdict& verdict) {
    std::vector<std::string> names;
    for (const Claim& claim : verdict.claims)
      if (!claim.holds) names.push_back(claim.name + ": " + claim.measured);
    return names;
  }
  // By the claims that are about drain holes.
  static std::vector<std::string> denied(const std::function<void(ExportedPrinter&)>& lie) {
    ExportedPrinter told = *exported_;
    lie(told);
    TriangleMesh outer_mesh, cavity;
    split_surfaces(told, &outer_mesh, &cavity);
    Verdict verdict;
    claim_frame(told, nullptr, &verdict);
    claim_drain(told, outer_mesh, cavity, Surface(outer_mesh), &verdict);
    return denied(verdict);
  }
  static testing::Matcher<std::vector<std::string>> says_no_to(const std::string& claim) {
    return testing::Contains(testing::StartsWith(claim));
  }

  static inline test::TemporaryFolder* folder_ = nullptr;
  static inline ExportedPrinter* exported_ = nullptr;
};

TEST_F(DrainCheck, AnHonestResultHasTwoHolesAndHoldsInEveryClaim) {
  EXPECT_EQ(exported_->drain->holes.size(), 2u);
  EXPECT_EQ(exported_->drain->caps, 2);
  EXPECT_TRUE(exported_->drain->sealed.empty());
  RunContext context;
  const auto verdicts = check_directory(honest(), context);
  ASSERT_TRUE(verdicts.ok()) << verdicts.error().message;
  EXPECT_THAT(denied(verdicts->front()), testing::IsEmpty());
  EXPECT_THAT(denied([](ExportedPrinter&) {}), testing::IsEmpty());
}

TEST_F(DrainCheck, AHoleNarrowerOrWiderThanReportedIsSeen) {
  for (const double beside : {-1.0, 1.0})
    EXPECT_THAT(denied([&](ExportedPrinter& told) { told.drain->holes[0].diameter_mm += beside; }),
                says_no_to("drain holes are open"));
}

TEST_F(DrainCheck, AHoleThatIsNotThereIsSeen) {
  EXPECT_THAT(denied([](ExportedPrinter& told) { told.drain->holes[0].axis *= -1.0; }),
              says_no_to("drain holes are open"));
}

TEST_F(DrainCheck, AHoleThatIsNotToldOfIsSeen) {
  EXPECT_THAT(denied([](ExportedPrinter& told) { told.drain->holes.pop_back(); }),
              says_no_to("skin triangulation"));
}

TEST_F(DrainCheck, AHoleThatIsOpenButReportedAsNotCutIsSeen) {
  EXPECT_THAT(denied([](ExportedPrinter& told) {
                told.drain->uncut.push_back(told.drain->holes.back());
                told.drain->holes.pop_back();
              }),
              says_no_to("drain holes that are reported as not cut"));
}

TEST_F(DrainCheck, AHoleThatCouldNotBeCutIsClosed) {
  // Beside the first hole, where the skin is whole, stands one that is told of as not cut.
  EXPECT_THAT(denied([](ExportedPrinter& told) {
                ExportedHole beside = told.drain->holes[0];
                const double apart = beside.diameter_mm;
                beside.centre_mm += apart * beside.axis.unitOrthogonal();
                beside.diameter_mm = 2.0;
                told.drain->uncut.push_back(beside);
              }),
              testing::Not(says_no_to("drain holes that are reported as not cut")));
}

TEST_F(DrainCheck, AStrutInTheHoleIsSeen) {
  EXPECT_THAT(denied([](ExportedPrinter& told) { told.drain->holes[0].diameter_mm *= 2.0; }),
              says_no_to("no strut stands in a drain hole"));
}

TEST_F(DrainCheck, AHollowThatIsNamedButIsNoneIsSeen) {
  EXPECT_THAT(denied([](ExportedPrinter& told) {
                told.drain->sealed.push_back({50.0, {0, 0, 18}});
              }),
              says_no_to("all void is reached"));
}

TEST_F(DrainCheck, AHollowThatIsSealedAndNotNamedIsSeen) {
  EXPECT_THAT(denied([](ExportedPrinter& told) {
                // Beside the body a ball with a hollow of 4 mm3.
                TriangleMesh ball = bodies::sphere(1.0, 2);
                const Eigen::Vector3d at = bounding_box(*told.merged).max + Eigen::Vector3d(20, 20, 20);
                const int shell = static_cast<int>(told.merged->vertices.size());
                for (const double grown : {2.0, 1.0})
                  for (const Eigen::Vector3d& p : ball.vertices)
                    told.merged->vertices.push_back(at + grown * (p - Eigen::Vector3d(0, 0, 1)));
                const int hollow = shell + static_cast<int>(ball.vertices.size());
                for (const auto& [a, b, c] : ball.triangles) {
                  told.merged->triangles.push_back({shell + a, shell + b, shell + c});
                  told.merged->triangles.push_back({hollow + a, hollow + c, hollow + b});
                }
              }),
              says_no_to("all void is reached"));
}

TEST_F(DrainCheck, CapsThatAreTooTightOrMissingAreSeen) {
  EXPECT_THAT(denied([](ExportedPrinter& told) { told.drain->cap_clearance_mm *= 0.5; }),
              says_no_to("caps fit"));
  EXPECT_THAT(denied([](ExportedPrinter& told) { told.drain->caps = 3; }), says_no_to("caps fit"));
}

TEST_F(DrainCheck, ASurfaceThatLidsDoNotCloseIsSeen) {
  EXPECT_THAT(denied([](ExportedPrinter& told) { --told.solid_triangles; }),
              says_no_to("lids close the surface"));
}

}  // namespace
}  // namespace skinframe::check
