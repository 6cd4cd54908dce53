// SPDX-License-Identifier: Apache-2.0
// Processes die by real signals; what was acknowledged is not lost, and what was watched has no gap.
#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/integration/farm.h"

namespace skinframe::integration {
namespace {

using nlohmann::json;

class Survival : public testing::Test {
 protected:
  // A body that takes some seconds, so that there is a middle to strike in.
  std::filesystem::path mesh() {
    const auto path = scratch_ / "hanging-ball.stl";
    if (!std::filesystem::exists(path)) {
      const Ran ran = run({binary("skinframe"), "sample", "hanging-ball", "--out", path}, scratch_.path());
      EXPECT_EQ(ran.exit_code, 0) << ran.err;
    }
    return path;
  }
  std::vector<std::string> job() {
    return {mesh(),   "--printer",      "sinterstation-hiq", "--size", "200",
            "--load", "side:top:5,0,0", "--verify",          "off"};
  }
  std::vector<std::int64_t> sequences(const std::string& lines) {
    std::vector<std::int64_t> found;
    std::istringstream in(lines);
    for (std::string line; std::getline(in, line);) {
      const json event = json::parse(line, nullptr, false);
      EXPECT_FALSE(event.is_discarded()) << line;
      // Protobuf's JSON writes 64-bit numbers as strings.
      const json& sequence = event.at("sequence");
      found.push_back(sequence.is_string() ? std::stoll(sequence.get<std::string>())
                                           : sequence.get<std::int64_t>());
    }
    return found;
  }
  void expect_gap_free(const std::vector<std::int64_t>& sequences, std::int64_t first) {
    ASSERT_FALSE(sequences.empty());
    for (std::size_t i = 0; i < sequences.size(); ++i)
      ASSERT_EQ(sequences[i], first + static_cast<std::int64_t>(i));
  }

  Scratch scratch_;
};

TEST_F(Survival, AKilledWorkersJobIsTakenUpAgainAndSucceeds) {
  Farm farm(scratch_);
  Process& first = farm.start_worker("first");
  const std::string id = farm.submit(job());
  ASSERT_FALSE(id.empty());
  ASSERT_TRUE(farm.at_work(id));
  first.signal(SIGKILL);
  ASSERT_EQ(first.wait(), 128 + SIGKILL);

  farm.start_worker("second");
  Process watch(farm.client({"--json", "watch", id}), scratch_ / "watch");
  EXPECT_EQ(watch.wait(Seconds(240)), 0) << watch.err();
  expect_gap_free(sequences(watch.out()), 1);
  const json ended = json::parse(farm.ask({"--json", "get", id}).out);
  EXPECT_NE(ended.at("state").get<std::string>().find("SUCCEEDED"), std::string::npos) << ended.dump();
  EXPECT_EQ(ended.at("attempt").get<int>(), 2);
}

TEST_F(Survival, AKilledServerLosesNothingItAcknowledgedAndWatchesResume) {
  Farm farm(scratch_);
  std::vector<std::string> ids;
  for (int i = 0; i < 5; ++i) ids.push_back(farm.submit(job()));
  farm.start_worker("only");
  ASSERT_TRUE(farm.at_work(ids[0]));
  Process watch(farm.client({"--json", "watch", ids[0]}), scratch_ / "watch");
  ASSERT_TRUE(eventually([&] { return !watch.out().empty(); }));
  farm.kill_server();
  farm.start_server();
  for (const std::string& id : ids) EXPECT_FALSE(farm.state_of(id).empty()) << id;
  // The watch that began before the kill goes on to the end of the job, and misses nothing.
  EXPECT_EQ(watch.wait(Seconds(240)), 0) << watch.err();
  expect_gap_free(sequences(watch.out()), 1);
  EXPECT_NE(farm.state_of(ids[0]).find("SUCCEEDED"), std::string::npos);
  for (std::size_t i = 1; i < ids.size(); ++i) EXPECT_EQ(farm.ask({"cancel", ids[i]}).exit_code, 0);
  farm.stop_server();
}

TEST_F(Survival, TwoWatchersSeeTheSameEventsFromAnySequenceNumber) {
  Farm farm(scratch_);
  farm.start_worker("only");
  const std::string id = farm.submit(job());
  Process live(farm.client({"watch", id}), scratch_ / "live");
  EXPECT_EQ(live.wait(Seconds(240)), 0) << live.err();
  std::vector<std::string> lines;
  std::istringstream in(live.out());
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  ASSERT_GT(lines.size(), 5u);
  for (const std::size_t after : {std::size_t{0}, std::size_t{1}, lines.size() / 2, lines.size() - 1}) {
    const Ran again = farm.ask({"watch", id, "--from", std::to_string(after)});
    EXPECT_EQ(again.exit_code, 0) << again.err;
    std::string wanted;
    for (std::size_t i = after; i < lines.size(); ++i) wanted += lines[i] + "\n";
    EXPECT_EQ(again.out, wanted) << "after " << after;
  }
}

TEST_F(Survival, ACancelledJobEndsWithinTwoSecondsOfWork) {
  Farm farm(scratch_);
  farm.start_worker("only");
  const std::string id = farm.submit(job());
  ASSERT_TRUE(farm.at_work(id));
  ASSERT_EQ(farm.ask({"cancel", id}).exit_code, 0);
  // 2 s to obey, one heartbeat to hear of it, and room for a busy machine.
  EXPECT_TRUE(
      eventually([&] { return farm.state_of(id).find("CANCELLED") != std::string::npos; }, Seconds(5)));
}

TEST_F(Survival, AMeshThatCannotBeReadFailsItsJobAndNoOther) {
  Farm farm(scratch_);
  farm.start_worker("only");
  const auto broken = scratch_ / "broken.stl";
  std::ofstream(broken) << "solid nothing\nendsolid\n";
  const std::string bad = farm.submit({broken, "--printer", "sinterstation-hiq", "--size", "100"});
  const std::string good =
      farm.submit({mesh(), "--printer", "sinterstation-hiq", "--size", "60", "--skin-nodes", "60"});
  EXPECT_EQ(farm.ask({"watch", good}).exit_code, 0);
  EXPECT_NE(farm.state_of(good).find("SUCCEEDED"), std::string::npos);
  const json ended = json::parse(farm.ask({"--json", "get", bad}).out);
  EXPECT_NE(ended.at("state").get<std::string>().find("FAILED"), std::string::npos);
  EXPECT_NE(ended.at("reason").get<std::string>().find("INVALID_INPUT"), std::string::npos);
}

}  // namespace
}  // namespace skinframe::integration
