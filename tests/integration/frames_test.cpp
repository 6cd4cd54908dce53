// SPDX-License-Identifier: Apache-2.0
// Frame problems through the real programs: the optimiser alone, on this machine and as a job of a farm.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/integration/farm.h"
#include "tests/integration/process.h"
#include "tests/integration/tower_problem.h"

namespace skinframe::integration {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class Frames : public testing::Test {
 protected:
  Ran skinframe(std::vector<std::string> words) {
    words.insert(words.begin(), binary("skinframe"));
    return run(words, scratch_.path());
  }
  std::string write(const std::string& name, const json& problem) {
    std::ofstream(scratch_ / name) << problem;
    return scratch_ / name;
  }
  json read(const std::filesystem::path& path) { return json::parse(read_file(path)); }

  Scratch scratch_;
};

TEST_F(Frames, ARunMakesWhatSolveFrameMakesAndTheCheckSaysYes) {
  const std::string problem = write("tower.json", tower(4, 4, 6, 40));
  const Ran job = skinframe({"run", problem, "--out", scratch_ / "out"});
  ASSERT_EQ(job.exit_code, 0) << job.err;
  EXPECT_THAT(job.out, HasSubstr("topology"));
  const Ran alone = skinframe({"solve-frame", problem, "--out", scratch_ / "alone.json", "--json"});
  ASSERT_EQ(alone.exit_code, 0) << alone.err;
  json of_job = read(scratch_ / "out" / "result.json"), of_verb = read(scratch_ / "alone.json");
  for (json* result : {&of_job, &of_verb}) result->erase("seconds");
  EXPECT_EQ(of_job, of_verb);
  EXPECT_EQ(json::parse(alone.out)["volumes_mm3"], of_verb["volumes_mm3"]);
  EXPECT_THAT(alone.err, HasSubstr("iteration"));
  const Ran check = skinframe({"check", scratch_ / "out"});
  EXPECT_EQ(check.exit_code, 0) << check.out << check.err;
}

TEST_F(Frames, TheFrameOfAMeshIsAProblemOfItsOwn) {
  const std::string egg = scratch_ / "egg.stl";
  ASSERT_EQ(skinframe({"sample", "egg", "--out", egg}).exit_code, 0);
  const Ran mesh =
      skinframe({"run", egg, "--printer", "sinterstation-hiq", "--size", "60", "--skin-nodes", "60", "--load",
                 "side:top:1,0,0", "--verify", "off", "--out", scratch_ / "egg"});
  ASSERT_EQ(mesh.exit_code, 0) << mesh.err;
  const Ran again = skinframe({"solve-frame", scratch_ / "egg" / "sinterstation-hiq" / "frame.json", "--out",
                               scratch_ / "again.json"});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  const double first =
      read(scratch_ / "egg" / "report.json")["printers"][0]["frame_volume_mm3"].get<double>();
  const double second = read(scratch_ / "again.json")["volumes_mm3"]["geometry"].get<double>();
  EXPECT_LE(second, first * (1 + 1e-6)) << "the frame that was exported keeps its own limits";
}

TEST_F(Frames, AJobStartsFromAnEarlierOneOfTheSameMesh) {
  Farm farm(scratch_);
  farm.start_worker("only");
  const std::string egg = scratch_ / "egg.stl";
  ASSERT_EQ(skinframe({"sample", "egg", "--out", egg}).exit_code, 0);
  const auto push = [&](const char* newtons) {
    return std::vector<std::string>{egg,        "--printer", "sinterstation-hiq",
                                    "--size",   "60",        "--skin-nodes",
                                    "60",       "--load",    std::string("side:top:") + newtons + ",0,0",
                                    "--verify", "off"};
  };
  const auto with = [](std::vector<std::string> words, const std::vector<std::string>& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  EXPECT_EQ(farm.ask(with({"submit"}, with(push("2"), {"--warm-start", "nobody"}))).exit_code, 9);
  const std::string earlier = farm.submit(push("20"));
  ASSERT_EQ(farm.ask({"watch", earlier}).exit_code, 0);
  const Ran warm = farm.ask(
      with({"submit"}, with(push("25"), {"--warm-start", earlier, "--watch", "--out", scratch_ / "warm"})));
  ASSERT_EQ(warm.exit_code, 0) << warm.err;
  const json start = read(scratch_ / "warm" / "report.json")["printers"][0]["warm_start"];
  EXPECT_EQ(start["job_id"], earlier);
  EXPECT_EQ(start["reused"], json({"sampled frame", "reduced frame", "radii"})) << start.dump();
  EXPECT_EQ(skinframe({"check", scratch_ / "warm"}).exit_code, 0);
}

TEST_F(Frames, EachEndHasItsStateItsReasonAndItsExitCode) {
  Farm farm(scratch_);
  farm.start_worker("only");
  json weak = tower(3, 3, 4, 1e5), broken = tower(3, 3, 4, 10), beam = broken;
  broken["struts"][7]["b"] = 4000;
  beam["mechanics"] = "beam";
  const Ran infeasible =
      farm.ask({"submit", write("weak.json", weak), "--watch", "--out", scratch_ / "weak"});
  EXPECT_EQ(infeasible.exit_code, 4) << infeasible.err;
  EXPECT_THAT(infeasible.out, HasSubstr("best reachable displacement"));
  EXPECT_TRUE(std::filesystem::exists(scratch_ / "weak" / "result.json"));
  EXPECT_EQ(skinframe({"check", scratch_ / "weak"}).exit_code, 0);
  const Ran wrong = farm.ask({"submit", write("broken.json", broken), "--watch"});
  EXPECT_EQ(wrong.exit_code, 3) << wrong.err;
  EXPECT_THAT(wrong.err, HasSubstr("INVALID_INPUT: broken.json: struts[7].b: 4000 is not a node"));
  const Ran unbuilt = farm.ask({"submit", write("beam.json", beam), "--watch"});
  EXPECT_EQ(unbuilt.exit_code, 2) << unbuilt.err;
  EXPECT_THAT(unbuilt.err, HasSubstr("\"beam\""));
  const Ran printer = farm.ask({"submit", scratch_ / "weak.json", "--printer", "sinterstation-hiq"});
  EXPECT_EQ(printer.exit_code, 2) << printer.err;
  EXPECT_THAT(printer.err, HasSubstr("sinterstation-hiq"));
  for (const auto& [name, code] : {std::pair("weak.json", 4), std::pair("broken.json", 3)})
    EXPECT_EQ(skinframe({"solve-frame", scratch_ / name, "--out", scratch_ / "local.json"}).exit_code, code);
}

TEST_F(Frames, CtrlCEndsTheLocalSolveWithSix) {
  Process process({binary("skinframe"), "solve-frame", write("large.json", tower(10, 10, 20, 200)), "--out",
                   scratch_ / "never.json"},
                  scratch_ / "interrupted");
  ASSERT_TRUE(
      eventually([&] { return process.err().find("iteration") != std::string::npos || !process.running(); }));
  process.signal(SIGINT);
  EXPECT_EQ(process.wait(Seconds(20)), 6) << process.err();
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "never.json"));
}

// 2000 nodes, 15600 struts: long enough to watch, and to be ended in its midst.
TEST_F(Frames, ALargeSolveIsSeenTwiceASecondAndEndsWithinASecondOfItsCancellation) {
  Farm farm(scratch_);
  farm.start_worker("only");
  const std::string id = farm.submit({write("large.json", tower(10, 10, 20, 200))});
  ASSERT_FALSE(id.empty());
  Process watch(farm.client({"--json", "watch", id}), scratch_ / "watch");
  const auto whole = [](const json& event) {
    const json& p = event.value("progress", json::object());
    return p.contains("frame_volume_mm3") && p.contains("violation") && p.contains("struts_left") &&
           p.contains("iteration");
  };
  const auto events = [&] {
    std::vector<json> all;
    std::istringstream in(watch.out());
    for (std::string line; std::getline(in, line);)
      if (json event = json::parse(line, nullptr, false); !event.is_discarded())
        all.push_back(std::move(event));
    return all;
  };
  const auto seen = [&] {
    const auto all = events();
    return std::count_if(all.begin(), all.end(), whole);
  };
  ASSERT_TRUE(eventually([&] { return seen() > 0 || !watch.running(); })) << watch.err();
  const auto first = std::chrono::steady_clock::now();
  const auto before = seen();
  ASSERT_TRUE(eventually([&] { return seen() >= before + 6 || !watch.running(); }));
  const Seconds took = std::chrono::steady_clock::now() - first;
  ASSERT_TRUE(watch.running()) << "it ended before it could be watched";
  EXPECT_LT(took.count(), 3.0) << "6 events";
  const auto cancelled = std::chrono::steady_clock::now();
  ASSERT_EQ(farm.ask({"cancel", id}).exit_code, 0);
  EXPECT_EQ(watch.wait(Seconds(10)), 6) << watch.err();
  const Seconds ended = std::chrono::steady_clock::now() - cancelled;
  EXPECT_LT(ended.count(), 1.5) << "a second, and room for a busy machine to start two programs";
}

}  // namespace
}  // namespace skinframe::integration
