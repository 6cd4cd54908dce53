// SPDX-License-Identifier: GPL-3.0-or-later
// Whole jobs on sample bodies.
#include "worker/pipeline/pipeline.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

#include "tests/worker/pipeline/box_body.h"
#include "tests/worker/pipeline/small_job.h"
#include "tests/worker/skin/bodies.h"
#include "worker/check/check.h"

namespace skinframe {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

json read_json(const fs::path& path) {
  std::ifstream in(path);
  return json::parse(in);
}

std::string read_bytes(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return std::string((std::istreambuf_iterator<char>(in)), {});
}

TEST(Pipeline, ARefusedPrinterDoesNotSinkTheOthers) {
  test::TemporaryFolder folder;
  JobRequest request = test::sample_job("egg", 60, 60, folder.path());
  PrinterRequest small = test::sinterstation_pa();
  small.printer.id = "matchbox";
  small.printer.tray_mm = {30, 20, 10};
  request.printers.insert(request.printers.begin(), small);
  RunContext context;
  auto outcomes = run_pipeline(request, folder.path() / "out", PipelineObserver{}, context);
  ASSERT_TRUE(outcomes.ok()) << outcomes.error().message;
  EXPECT_EQ((*outcomes)[0].reason, Reason::kDoesNotFit);
  EXPECT_FALSE(fs::exists(folder.path() / "out" / "matchbox"));
  EXPECT_TRUE((*outcomes)[1].succeeded()) << (*outcomes)[1].detail;
  EXPECT_TRUE(fs::exists(folder.path() / "out" / "sinterstation-hiq" / "skin-frame.stl"));
}

TEST(Pipeline, ABodyThinEverywhereComesBackSolidWithAWarning) {
  test::TemporaryFolder folder;
  JobRequest request = test::sample_job("egg", 60, 60, folder.path());
  TriangleMesh plate = test::box_mesh();
  for (auto& v : plate.vertices) v.z() *= 1.6 / 40;
  ASSERT_TRUE(write_stl(plate, request.mesh_path).ok());
  request.options.size_mm = std::nullopt;
  request.options.verify = true;
  RunContext context;
  auto outcomes = run_pipeline(request, folder.path() / "out", PipelineObserver{}, context);
  ASSERT_TRUE(outcomes.ok()) << outcomes.error().message;
  ASSERT_TRUE(outcomes->front().succeeded()) << outcomes->front().detail;
  const json report = read_json(folder.path() / "out" / "report.json")["printers"][0];
  EXPECT_EQ(report["termination"]["reason"], "SOLID");
  EXPECT_DOUBLE_EQ(report["ratio"], 1.0);
  EXPECT_DOUBLE_EQ(report["printed_ratio"], 1.0);
  EXPECT_NEAR(report["printed_volume_mm3"].get<double>(), 20 * 30 * 1.6, 1e-3);
  EXPECT_DOUBLE_EQ(report["thin"]["fraction"], 1.0);
  EXPECT_EQ(report["counts"]["geometry"]["struts"], 0);
  EXPECT_EQ(report["balance"], "holds");
  EXPECT_EQ(report["verification"]["label"], "not verified") << "there is no frame";
  ASSERT_EQ(report["warnings"].size(), 1u);
  EXPECT_NE(report["warnings"][0].get<std::string>().find("solid"), std::string::npos);
  auto verdicts = check::check_directory(folder.path() / "out", context);
  ASSERT_TRUE(verdicts.ok()) << verdicts.error().message;
  EXPECT_TRUE(verdicts->front().holds()) << check::to_text(*verdicts);

  json lie = read_json(folder.path() / "out" / "report.json");
  lie["printers"][0]["profile"]["skin_thickness_mm"] = 0.4;  // half of it would be hollow
  std::ofstream(folder.path() / "out" / "report.json") << lie;
  verdicts = check::check_directory(folder.path() / "out", context);
  ASSERT_TRUE(verdicts.ok()) << verdicts.error().message;
  EXPECT_FALSE(verdicts->front().holds()) << check::to_text(*verdicts);
}

TEST(Pipeline, AThinSheetIsToldSolidAndWithoutInternalNodes) {
  test::TemporaryFolder folder;
  JobRequest request = test::sample_job("egg", 60, 60, folder.path());
  // A block of 19.2 x 20 x 40 mm with a fin of 1.2 x 20 x 40 mm on its side.
  const TriangleMesh body =
      bodies::blocks({16, 8, 8}, {1.2, 5, 5}, [](int x, int y, int) { return y < 4 || x == 8; });
  ASSERT_TRUE(write_stl(body, request.mesh_path).ok());
  request.options.size_mm = std::nullopt;
  request.options.no_optimize = true;
  request.options.internal_nodes = 20;
  RunContext context;
  auto outcomes = run_pipeline(request, folder.path() / "out", PipelineObserver{}, context);
  ASSERT_TRUE(outcomes.ok()) << outcomes.error().message;
  ASSERT_TRUE(outcomes->front().succeeded()) << outcomes->front().detail;
  const json report = read_json(folder.path() / "out" / "report.json")["printers"][0];
  const double fin = 1.2 * 20 * 40;
  EXPECT_NEAR(report["thin"]["volume_mm3"].get<double>(), fin, 0.06 * fin);
  EXPECT_EQ(report["thin"]["regions"][0]["kind"], "sheet");
  EXPECT_GE(report["skin_volume_mm3"].get<double>(), fin + 2 * (20 + 19.2) * 40);  // four sides, and the fin
  const json frame = read_json(folder.path() / "out" / "sinterstation-hiq" / "frame.json");
  std::set<int> on_skin;
  for (const json& t : frame["skin_triangles"]) on_skin.insert(t.begin(), t.end());
  std::size_t internal = 0;
  for (std::size_t i = 0; i < frame["nodes"].size(); ++i) {
    if (on_skin.contains(static_cast<int>(i))) continue;
    ++internal;
    EXPECT_LT(frame["nodes"][i][1].get<double>(), 0.0);  // placed, the fin stands at y > 0
  }
  EXPECT_GT(internal, 0u);
}

TEST(Pipeline, SameInputAndSeedGiveTheSameFrame) {
  test::TemporaryFolder folder;
  JobRequest request = test::sample_job("egg", 60, 60, folder.path());
  request.loads = {{"side", Place::kTop, {2, 0, 0}, 5}};
  std::string frames[2];
  for (int i = 0; i < 2; ++i) {
    RunContext context;
    context.threads = i + 1;
    const fs::path out = folder.path() / std::to_string(i);
    ASSERT_TRUE(run_pipeline(request, out, PipelineObserver{}, context).ok());
    frames[i] = read_bytes(out / "sinterstation-hiq" / "frame.json");
  }
  EXPECT_FALSE(frames[0].empty());
  EXPECT_TRUE(frames[0] == frames[1]);
}

TEST(Pipeline, PrintersSideBySideGiveWhatTheyGiveOneAfterAnother) {
  test::TemporaryFolder folder;
  JobRequest request = test::sample_job("egg", 40, 60, folder.path());
  request.printers.push_back(test::sinterstation_pa());
  request.printers.back().printer.id = "finer";
  request.printers.back().printer.min_radius_mm = 0.4;
  request.printers.push_back(test::sinterstation_pa());
  request.printers.back().printer.id = "matchbox";
  request.printers.back().printer.tray_mm = {30, 20, 10};
  const std::vector<std::string> ids = {"sinterstation-hiq", "finer", "matchbox"};
  std::vector<std::string> ended;
  std::atomic<int> inside = 0;  // of the observer
  PipelineObserver observer;
  observer.progress = [&](const PipelineProgress&) {
    EXPECT_EQ(++inside, 1) << "called one at a time";
    --inside;
  };
  observer.printer_ended = [&](const PrinterOutcome& outcome) { ended.push_back(outcome.printer); };
  json reports[2];
  for (int i = 0; i < 2; ++i) {
    RunContext context;
    context.threads = 1 + 2 * i;
    const fs::path out = folder.path() / std::to_string(i);
    ended.clear();
    auto outcomes = run_pipeline(request, out, observer, context);
    ASSERT_TRUE(outcomes.ok()) << outcomes.error().message;
    for (std::size_t k = 0; k < ids.size(); ++k) EXPECT_EQ((*outcomes)[k].printer, ids[k]);
    EXPECT_THAT(ended, testing::UnorderedElementsAreArray(ids));
    reports[i] = read_json(out / "report.json");
    for (json& printer : reports[i]["printers"]) printer.erase("seconds");
  }
  EXPECT_EQ(reports[0], reports[1]);
  for (const char* file : {"skin-frame.stl", "frame.json"})
    for (const char* id : {"sinterstation-hiq", "finer"})
      EXPECT_TRUE(read_bytes(folder.path() / "0" / id / file) == read_bytes(folder.path() / "1" / id / file))
          << id << "/" << file;
}

TEST(Pipeline, ProgressNamesEveryStageInOrder) {
  test::TemporaryFolder folder;
  JobRequest request = test::sample_job("egg", 60, 60, folder.path());
  request.options.verify = true;
  std::vector<Stage> stages;
  PipelineObserver observer;
  observer.progress = [&](const PipelineProgress& p) {
    if (stages.empty() || stages.back() != p.progress.stage) stages.push_back(p.progress.stage);
  };
  RunContext context;
  ASSERT_TRUE(run_pipeline(request, folder.path() / "out", observer, context).ok());
  for (const Stage stage :
       {Stage::kRead, Stage::kRepair, Stage::kSkin, Stage::kSample, Stage::kSize, Stage::kExport})
    EXPECT_NE(std::find(stages.begin(), stages.end(), stage), stages.end()) << to_string(stage);
  EXPECT_EQ(stages.back(), Stage::kVerify);
}

TEST(Pipeline, CancellationEndsTheJobWithoutAResult) {
  test::TemporaryFolder folder;
  JobRequest request = test::sample_job("egg", 60, 60, folder.path());
  request.printers.push_back(test::sinterstation_pa());
  request.printers.back().printer.id = "another";
  std::stop_source stop;
  PipelineObserver observer;
  observer.progress = [&](const PipelineProgress& p) {
    if (p.progress.stage == Stage::kSize) stop.request_stop();
  };
  RunContext context;
  context.stop = stop.get_token();
  context.threads = 2;
  auto outcomes = run_pipeline(request, folder.path() / "out", observer, context);
  ASSERT_FALSE(outcomes.ok());
  EXPECT_EQ(outcomes.error().kind, ErrorKind::kCancelled);
  EXPECT_FALSE(fs::exists(folder.path() / "out" / "report.json"));
}

TEST(Pipeline, WithoutOptimisationRadiiStandAtTheirLowerBoundsAndNoLimitIsClaimed) {
  test::TemporaryFolder folder;
  JobRequest request = test::sample_job("egg", 60, 60, folder.path());
  request.options.no_optimize = true;
  RunContext context;
  auto outcomes = run_pipeline(request, folder.path() / "out", PipelineObserver{}, context);
  ASSERT_TRUE(outcomes.ok());
  ASSERT_TRUE(outcomes->front().succeeded());
  const json report = read_json(folder.path() / "out" / "report.json");
  EXPECT_EQ(report["printers"][0]["termination"]["reason"], "NOT_OPTIMIZED");
  EXPECT_EQ(report["printers"][0]["min_radius_mm"], 0.5);
}

// Figure 7 of the paper: with the smaller base the centre of gravity of the light structure would fall
// outside, and mass has to go low and to the other side: into the pillar.
TEST(Pipeline, TheSmallerBaseGetsAThickerPillar) {
  test::TemporaryFolder folder;
  double pillar_mm3[2] = {0, 0};
  const char* names[2] = {"hanging-ball", "hanging-ball-small-base"};
  for (int i = 0; i < 2; ++i) {
    JobRequest request = test::sample_job(names[i], 200, 260, folder.path());
    request.options.balance = BalanceMode::kRequire;
    RunContext context;
    const fs::path out = folder.path() / names[i];
    auto outcomes = run_pipeline(request, out, PipelineObserver{}, context);
    ASSERT_TRUE(outcomes.ok()) << outcomes.error().message;
    ASSERT_TRUE(outcomes->front().succeeded()) << names[i] << ": " << outcomes->front().detail;
    const json report = read_json(out / "report.json");
    EXPECT_EQ(report["printers"][0]["balance"], "holds");
    const json frame = read_json(out / "sinterstation-hiq" / "frame.json");
    for (const json& strut : frame["struts"]) {
      Eigen::Vector3d a, b;
      for (int k = 0; k < 3; ++k) {
        a[k] = frame["nodes"][strut["a"].get<int>()][k];
        b[k] = frame["nodes"][strut["b"].get<int>()][k];
      }
      const Eigen::Vector3d middle = 0.5 * (a + b);
      const double r = strut["radius_mm"];
      // Above the base plate and below the arm.
      if (middle.z() > 20 && middle.z() < 130) pillar_mm3[i] += std::numbers::pi * r * r * (b - a).norm();
    }
  }
  EXPECT_GT(pillar_mm3[1], 1.05 * pillar_mm3[0]);
}

}  // namespace
}  // namespace skinframe
