// SPDX-License-Identifier: GPL-3.0-or-later
// The claims about support struts, and a lie for each of them. Lies are told to the claims themselves, in
// what was read from one honest result's files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "tests/worker/pipeline/small_job.h"
#include "worker/check/check.h"
#include "worker/check/claims.h"

namespace skinframe::check {
namespace {

// A ball that hangs over: supports within and outside.
class SupportCheck : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new test::TemporaryFolder;
    JobRequest request = test::sample_job("hanging-ball", 70, 80, folder_->path());
    request.printers = {test::makerbot_pla()};
    RunContext context;
    auto outcomes = run_pipeline(request, honest(), PipelineObserver{}, context);
    ASSERT_TRUE(outcomes.ok() && outcomes->front().succeeded());
    auto exported = read_exported(honest(), context);
    ASSERT_TRUE(exported.ok()) << exported.error().message;
    result_ = new ExportedPrinter(std::move(exported.value().printers.front()));
    ASSERT_TRUE(result_->supports.has_value());
    TriangleMesh cavity;
    outer_ = new TriangleMesh;
    split_surfaces(*result_, outer_, &cavity);
    surface_ = new Surface(*outer_);
  }
  static void TearDownTestSuite() {
    delete surface_;
    delete outer_;
    delete result_;
    delete folder_;
  }
  static std::filesystem::path honest() { return folder_->path() / "honest"; }

  static std::vector<std::string> denied(const std::function<void(ExportedSupports&)>& lie) {
    ExportedPrinter copy = *result_;
    lie(*copy.supports);
    Verdict verdict;
    claim_supports(copy, *surface_, &verdict);
    claim_overhang(copy, *outer_, *surface_, &verdict);
    std::vector<std::string> names;
    for (const Claim& claim : verdict.claims)
      if (!claim.holds) names.push_back(claim.name);
    return names;
  }
  static bool stands_on_plate(const ExportedSupports& s, const ExportedSupportStrut& strut) {
    const int own = static_cast<int>(result_->frame.nodes_mm.size());
    return strut.lower >= own && s.nodes[strut.lower - own].on == "plate";
  }

  static test::TemporaryFolder* folder_;
  static ExportedPrinter* result_;
  static TriangleMesh* outer_;
  static Surface* surface_;
};
test::TemporaryFolder* SupportCheck::folder_ = nullptr;
ExportedPrinter* SupportCheck::result_ = nullptr;
TriangleMesh* SupportCheck::outer_ = nullptr;
Surface* SupportCheck::surface_ = nullptr;

using testing::Contains;

TEST_F(SupportCheck, AnHonestResultHoldsAndHasBothKinds) {
  RunContext context;
  auto verdicts = check_directory(honest(), context);
  ASSERT_TRUE(verdicts.ok()) << verdicts.error().message;
  EXPECT_TRUE(verdicts->front().holds()) << to_text(*verdicts);
  EXPECT_GT(result_->supports->internal, 0);
  EXPECT_GT(result_->supports->external, 0);
}

TEST_F(SupportCheck, AStrutThatIsNotDividedEnoughIsSeen) {
  EXPECT_THAT(denied([](ExportedSupports& s) {
                for (auto& [angle, length] : s.printable_length) length = std::min(length, 1.0);
              }),
              Contains("struts print without more support"));
  EXPECT_THAT(denied([](ExportedSupports& s) {
                for (ExportedSupportNode& node : s.nodes)
                  if (node.on == "strut") node.at_mm.x() += 0.5;
              }),
              Contains("struts print without more support"));
}

TEST_F(SupportCheck, ANodeWithoutAWayDownIsSeen) {
  EXPECT_THAT(denied([](ExportedSupports& s) { s.struts.erase(s.struts.begin()); }),
              Contains("every node has a way down"));
  EXPECT_THAT(denied([](ExportedSupports& s) {
                for (ExportedSupportNode& node : s.nodes)
                  if (node.on == "plate") node.at_mm.z() = 3.0;
              }),
              Contains("every node has a way down"));
}

TEST_F(SupportCheck, ASupportThatNothingNeedsIsSeen) {
  EXPECT_THAT(denied([](ExportedSupports& s) { s.struts.push_back(s.struts.front()); }),
              Contains("no support is useless"));
}

TEST_F(SupportCheck, ASupportThroughTheSkinIsSeen) {
  EXPECT_THAT(denied([](ExportedSupports& s) {
                for (ExportedSupportStrut& strut : s.struts)
                  if (stands_on_plate(s, strut)) strut.external = false;
              }),
              Contains("supports stay on their side of the skin"));
}

TEST_F(SupportCheck, FalseFiguresAreSeen) {
  EXPECT_THAT(denied([](ExportedSupports& s) { ++s.count; }), Contains("support figures"));
  EXPECT_THAT(denied([](ExportedSupports& s) { ++s.external; }), Contains("support figures"));
  for (double ExportedSupports::*figure :
       {&ExportedSupports::length_mm, &ExportedSupports::volume_mm3, &ExportedSupports::internal_volume_mm3,
        &ExportedSupports::external_volume_mm3, &ExportedSupports::weight_g})
    EXPECT_THAT(denied([&](ExportedSupports& s) { s.*figure *= 1.01; }), Contains("support figures"));
}

TEST_F(SupportCheck, AnOpenSupportMeshIsSeen) {
  EXPECT_THAT(denied([](ExportedSupports& s) { s.internal_mesh.triangles.pop_back(); }),
              Contains("supports are watertight"));
}

TEST_F(SupportCheck, SkinThatNothingHoldsIsSeen) {
  EXPECT_THAT(denied([](ExportedSupports& s) { s.struts.clear(); }), Contains("overhanging skin"));
  EXPECT_THAT(denied([](ExportedSupports& s) { s.beyond_share += 0.01; }), Contains("overhanging skin"));
}

TEST_F(SupportCheck, WithoutTheStrutsOutsideALayerStartsInTheAir) {
  ExportedPrinter copy = *result_;
  copy.supports->external_mesh = {};
  Verdict verdict;
  claim_layers(copy, &verdict);
  EXPECT_FALSE(verdict.claims.front().holds) << verdict.claims.front().measured;
}

// Fine detail smoothed, the best attitude looked for, supports on top of both.
TEST(SmoothedPrint, WithSupportsInItsBestAttitudeKeepsEveryClaim) {
  test::TemporaryFolder folder;
  JobRequest request = test::sample_job("relief", 50, 80, folder.path());
  request.printers = {test::makerbot_pla()};
  request.options.smooth = Smooth::kOn;
  request.options.orient = Orient::kBest;
  RunContext context;
  auto outcomes = run_pipeline(request, folder.path() / "out", PipelineObserver{}, context);
  ASSERT_TRUE(outcomes.ok() && outcomes->front().succeeded());
  auto exported = read_exported(folder.path() / "out", context);
  ASSERT_TRUE(exported.ok()) << exported.error().message;
  EXPECT_TRUE(exported->orientation.has_value());
  EXPECT_TRUE(exported->printers.front().added_skin_mm3.has_value());
  ASSERT_TRUE(exported->printers.front().supports.has_value());
  EXPECT_GT(exported->printers.front().supports->count, 0);
  auto verdicts = check_directory(folder.path() / "out", context);
  ASSERT_TRUE(verdicts.ok()) << verdicts.error().message;
  EXPECT_TRUE(verdicts->front().holds()) << to_text(*verdicts);
  EXPECT_THAT(to_text(*verdicts), testing::HasSubstr("orientation: by estimate"));
}

TEST_F(SupportCheck, AFalseDeformationIsSeen) {
  EXPECT_THAT(denied([](ExportedSupports& s) { s.worst_vertical_deformation_mm *= 0.5; }),
              Contains("deformation while printing (paper model)"));
}

}  // namespace
}  // namespace skinframe::check
