// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/job/run_frame_job.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <memory>
#include <sstream>

#include "tests/worker/pipeline/small_job.h"
#include "tests/worker/problem/sample_problem.h"
#include "worker/problem/problem_file.h"

namespace skinframe {
namespace {

using nlohmann::json;

class FrameJob : public ::testing::Test {
 protected:
  json run(const json& problem, std::stop_token stop = {}) {
    std::ofstream(folder_.path() / "problem.json") << problem;
    JobFile file;
    file.request.job_id = "j1";
    file.request.mesh_name = "tripod.json";
    file.frame_problem = folder_.path() / "problem.json";
    RunContext context;
    context.stop = stop;
    EventStream events(events_.get(), TimeLeft::kUnknown);
    return run_frame_job(file, out(), events, nullptr, context);
  }
  std::filesystem::path out() const { return folder_.path() / "out"; }
  json read(const char* name) const { return json::parse(std::ifstream(out() / name)); }
  std::vector<json> events() const {
    std::rewind(events_.get());
    std::string text(100'000, '\0');
    text.resize(std::fread(text.data(), 1, text.size(), events_.get()));
    std::istringstream in(text);
    std::vector<json> lines;
    for (std::string line; std::getline(in, line);) lines.push_back(json::parse(line));
    return lines;
  }

  test::TemporaryFolder folder_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> events_{std::tmpfile(), std::fclose};
};

TEST_F(FrameJob, ItsFilesAndItsOutcomeTellTheSame) {
  const json outcome = run(testing::sample_problem());
  EXPECT_EQ(outcome["state"], "SUCCEEDED");
  EXPECT_EQ(outcome["reason"], "NONE");
  const json report = read("report.json"), result = read("result.json");
  EXPECT_EQ(report["job_id"], "j1");
  const json& frame = report["frame"];
  EXPECT_EQ(frame["problem"], "tripod.json");
  EXPECT_EQ(frame["volumes_mm3"], result["volumes_mm3"]);
  EXPECT_EQ(outcome["frame"]["stages"][3]["frame_volume_mm3"], result["volumes_mm3"]["geometry"]);
  EXPECT_EQ(outcome["frame"]["stages"][1]["struts"], 6);
  EXPECT_EQ(outcome["frame"]["mechanics"], "axial");
  EXPECT_FALSE(frame.contains("struts")) << "what has one entry a strut is in result.json alone";
  EXPECT_TRUE(parse_problem(result).ok());
}

TEST_F(FrameJob, ProgressTellsVolumeViolationAndStrutsAndNoGuessOfTheTimeLeft) {
  run(testing::sample_problem());
  bool whole = false;
  for (const json& event : events()) {
    const json& progress = event.at("progress");
    EXPECT_FALSE(progress.contains("seconds_left"));
    EXPECT_FALSE(progress.contains("printer"));
    whole |= progress.contains("frame_volume_mm3") && progress.contains("violation") &&
             progress.contains("struts_left");
  }
  EXPECT_TRUE(whole);
}

TEST_F(FrameJob, InfeasibleIsFailedWithTheBestReachableValueAndTheBestFrame) {
  json weak = testing::sample_problem();
  weak["load_cases"][0]["forces"][0]["force_n"] = {0, 0, -1e5};
  const json outcome = run(weak);
  EXPECT_EQ(outcome["state"], "FAILED");
  EXPECT_EQ(outcome["reason"], "INFEASIBLE");
  EXPECT_EQ(outcome["frame"]["violated_constraint"], "displacement");
  EXPECT_GT(outcome["frame"]["best_reachable_displacement_mm"].get<double>(), 0.05);
  EXPECT_EQ(read("report.json")["frame"]["reason"], "INFEASIBLE");
  EXPECT_TRUE(parse_problem(read("result.json")).ok());
}

TEST_F(FrameJob, ABadFileIsInvalidInputByItsOwnNameFieldAndIndex) {
  json bad = testing::sample_problem();
  bad["struts"][3]["a"] = 900;
  const json outcome = run(bad);
  EXPECT_EQ(outcome["state"], "FAILED");
  EXPECT_EQ(outcome["reason"], "INVALID_INPUT");
  EXPECT_EQ(outcome["detail"], "tripod.json: struts[3].a: 900 is not a node (0..3)");
  EXPECT_FALSE(std::filesystem::exists(out()));
}

TEST_F(FrameJob, MechanicsThatAreNotBuiltAreRefusedByName) {
  json beam = testing::sample_problem();
  beam["mechanics"] = "timoshenko";
  const json outcome = run(beam);
  EXPECT_EQ(outcome["reason"], "UNSUPPORTED");
  EXPECT_THAT(outcome["detail"].get<std::string>(), ::testing::HasSubstr("\"timoshenko\""));
}

TEST_F(FrameJob, CancelledIsCancelled) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_EQ(run(testing::sample_problem(), stop.get_token())["state"], "CANCELLED");
}

}  // namespace
}  // namespace skinframe
