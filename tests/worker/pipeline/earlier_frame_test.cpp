// SPDX-License-Identifier: GPL-3.0-or-later
// A job that starts from an earlier one: what it may take over, what it must not, and how good it is.
#include "worker/pipeline/earlier_frame.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "tests/worker/pipeline/small_job.h"

namespace skinframe {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* kPrinter = "sinterstation-hiq";

json read(const fs::path& path) { return json::parse(std::ifstream(path)); }

class EarlierFrame : public ::testing::Test {
 protected:
  // One job of an egg pushed aside at its top serves all tests of this file.
  static void SetUpTestSuite() {
    folder_ = new test::TemporaryFolder;
    run(request(kForce), "earlier");
  }
  static void TearDownTestSuite() {
    delete folder_;
    folder_ = nullptr;
  }
  static constexpr double kForce = 20;
  static JobRequest request(double force_n) {
    JobRequest job = test::sample_job("egg", 60, 60, folder_->path());
    job.loads = {{"side", Place::kTop, {force_n, 0, 0}, 5}};
    return job;
  }
  static JobRequest warm(JobRequest job, const fs::path& file = initial()) {
    job.warm_start = EarlierJob{"j0", {{kPrinter, file}}};
    return job;
  }
  // The printer's part of the report.
  static json run(const JobRequest& job, const std::string& name) {
    RunContext context;
    const auto outcomes = run_pipeline(job, folder_->path() / name, PipelineObserver{}, context);
    EXPECT_TRUE(outcomes.ok()) << outcomes.error().message;
    return read(folder_->path() / name / "report.json")["printers"][0];
  }
  static fs::path initial() { return folder_->path() / "earlier" / kPrinter / "initial-frame.json"; }
  static json frame_of(const std::string& name) {
    return read(folder_->path() / name / kPrinter / "frame.json");
  }
  static fs::path spoiled(const std::function<void(json&)>& spoil) {
    json file = read(initial());
    spoil(file);
    std::ofstream(folder_->path() / "spoiled.json") << file;
    return folder_->path() / "spoiled.json";
  }

  static test::TemporaryFolder* folder_;
};
test::TemporaryFolder* EarlierFrame::folder_ = nullptr;

TEST_F(EarlierFrame, AStrongerPushStartsFromAllOfItAndEndsAsWellAsFromNothing) {
  const json cold = run(request(1.25 * kForce), "cold"), from = run(warm(request(1.25 * kForce)), "warm");
  ASSERT_EQ(cold["reason"], "NONE") << cold.dump(1);
  ASSERT_EQ(from["reason"], "NONE") << from.dump(1);
  EXPECT_EQ(from["warm_start"]["job_id"], "j0");
  EXPECT_EQ(from["warm_start"]["reused"], json({"sampled frame", "reduced frame", "radii"})) << from.dump(1);
  EXPECT_LE(from["geometry_volume_mm3"].get<double>(), 1.02 * cold["geometry_volume_mm3"].get<double>());
  EXPECT_LE(from["max_displacement_mm"].get<double>(), 0.05 * (1 + 1e-5));
  EXPECT_LT(from["iterations"]["interior_point"].get<int>(), cold["iterations"]["interior_point"].get<int>());
  EXPECT_FALSE(cold.contains("warm_start"));
  run(warm(request(1.25 * kForce)), "again");
  EXPECT_EQ(frame_of("warm"), frame_of("again")) << "same spec, same result";
}

TEST_F(EarlierFrame, AnotherSkinHasNothingToTakeOverAndRunsAsFromNothing) {
  JobRequest thick = request(kForce);
  thick.printers[0].printer.min_radius_mm = 0.6;
  const json from = run(warm(thick), "thick-warm");
  EXPECT_THAT(from["warm_start"]["reused"], IsEmpty());
  EXPECT_THAT(from["warm_start"]["detail"].get<std::string>(), HasSubstr("another skin"));
  EXPECT_THAT(from["warnings"].dump(), HasSubstr("warm start from job j0"));
}

TEST_F(EarlierFrame, AFileThatIsNoneOrIsSpoiledIsToldAndNotUsed) {
  const std::vector<std::pair<std::function<void(json&)>, const char*>> spoils = {
      {[](json& f) { f = json::array(); }, "problem: must be an object"},
      {[](json& f) { f["struts"][3]["a"] = 1 << 20; }, "struts[3].a"},
      {[](json& f) { f.erase("sampling"); }, "sampling"},
      {[](json& f) {
         f["sampling"]["contact_nodes"] = {0, 1};
       },
       "fewer than three"},
      {[](json& f) { f["sampling"]["contact_nodes"][0] = -1; }, "sampling.contact_nodes: -1"},
      {[](json& f) {
         f["reduced"]["struts"][0] = {0, 100000, 1};
       },
       "reduced.struts: 100000"},
      {[](json& f) { f["reduced"]["radii_mm"].push_back(1); }, "reduced.radii_mm"},
      {[](json& f) { f["reduced"]["radii_mm"][0] = -1; }, "reduced.radii_mm"},
      {[](json& f) { f["reduced"]["nodes"][0][0] = 7; }, "reduced.nodes[0] is moved"},
      {[](json& f) {
         f["reduced"]["nodes"].push_back({0, 0, 0});
         f["reduced"]["nodes"].push_back({0, 0, 0});
         while (f["reduced"]["nodes"].size() <= f["nodes"].size()) f["reduced"]["nodes"].push_back({0, 0, 0});
       },
       "reduced.nodes"}};
  for (const auto& [spoil, names] : spoils) {
    const auto frame = read_initial_frame(spoiled(spoil));
    ASSERT_FALSE(frame.ok()) << names;
    EXPECT_THAT(frame.error().message, HasSubstr(names));
  }
  ASSERT_TRUE(read_initial_frame(initial()).ok());
}

TEST_F(EarlierFrame, AReducedFrameThatCannotBeSizedIsLeftAndTheSampledOneServes) {
  // Internal struts gone, as an earlier job without loads leaves them; what is left bears less.
  const fs::path bare = spoiled([](json& f) {
    json struts = json::array(), radii = json::array();
    for (std::size_t j = 0; j < f["reduced"]["struts"].size(); ++j)
      if (f["reduced"]["struts"][j][2] == 1) {
        struts.push_back(f["reduced"]["struts"][j]);
        radii.push_back(f["reduced"]["radii_mm"][j]);
      }
    f["reduced"]["struts"] = struts;
    f["reduced"]["radii_mm"] = radii;
    f["reduced"]["volume_mm3"] = f["reduced"]["volume_mm3"].get<double>() / 10;  // a promise nobody can keep
  });
  const json from = run(warm(request(kForce), bare), "bare");
  EXPECT_THAT(from["warm_start"]["reused"], ElementsAre("sampled frame"));
  EXPECT_NE(from["warm_start"]["detail"], "");
  const json earlier = read(folder_->path() / "earlier" / "report.json")["printers"][0];
  EXPECT_NEAR(from["geometry_volume_mm3"].get<double>(), earlier["geometry_volume_mm3"].get<double>(),
              1e-3 * earlier["geometry_volume_mm3"].get<double>());
}

}  // namespace
}  // namespace skinframe
