// SPDX-License-Identifier: GPL-3.0-or-later
// A job of a mesh that goes on from a checkpoint writes the same files as one that was never broken off.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/worker/fixture/checkpoint_box.h"
#include "tests/worker/pipeline/small_job.h"

namespace skinframe {
namespace {

using nlohmann::json;

// All files by their path, report.json without the seconds.
std::map<std::string, std::string> files_of(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    std::ifstream in(entry.path(), std::ios::binary);
    std::stringstream text;
    text << in.rdbuf();
    std::string& content = files[entry.path().lexically_relative(folder).string()] = text.str();
    if (entry.path().filename() != "report.json") continue;
    json report = json::parse(content);
    for (json& printer : report["printers"]) printer.erase("seconds");
    content = report.dump();
  }
  return files;
}

TEST(PipelineCheckpoint, TheFilesAreThoseOfTheUnbrokenRunByteForByte) {
  test::TemporaryFolder folder;
  JobRequest request = test::sample_job("egg", 60, 60, folder.path());
  request.loads.push_back({"side", Place::kTop, {1, 0, 0}, 5});
  const auto run = [&](const std::string& out, testing::CheckpointBox& checkpoints) {
    RunContext context;
    PipelineObserver observer;
    observer.checkpoints = &checkpoints;
    const auto outcomes = run_pipeline(request, folder.path() / out, observer, context);
    ASSERT_TRUE(outcomes.ok() && outcomes->at(0).succeeded());
  };
  testing::CheckpointBox all;
  run("unbroken", all);
  if (HasFatalFailure()) return;
  ASSERT_GE(all.history().size(), 3u);
  EXPECT_EQ(all.history()[0].stage, "sample");
  // After sampling and sizing; topology and geometry are yet to come.
  testing::CheckpointBox earlier({all.history()[0], all.history()[1]});
  run("resumed", earlier);
  if (HasFatalFailure()) return;
  EXPECT_EQ(earlier.stages_used(), (std::vector<std::string>{"sample", "size"}));
  const auto unbroken = files_of(folder.path() / "unbroken"), resumed = files_of(folder.path() / "resumed");
  ASSERT_EQ(unbroken.size(), resumed.size());
  for (const auto& [path, content] : unbroken) EXPECT_TRUE(resumed.at(path) == content) << path;
}

}  // namespace
}  // namespace skinframe
