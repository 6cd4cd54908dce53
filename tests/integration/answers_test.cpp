// SPDX-License-Identifier: Apache-2.0
// What goes wrong for a user ends in one clear sentence and the exit code of the table in client/README.md.
#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>

#include "tests/integration/process.h"

namespace skinframe::integration {
namespace {

class Answers : public testing::Test {
 protected:
  Ran skinframe(std::vector<std::string> words) {
    words.insert(words.begin(), binary("skinframe"));
    return run(words, scratch_.path());
  }
  std::string sample(const std::string& name) {
    const std::string path = scratch_ / (name + ".stl");
    EXPECT_EQ(skinframe({"sample", name, "--out", path}).exit_code, 0);
    return path;
  }
  std::string write(const std::string& name, const std::string& content) {
    std::ofstream(scratch_ / name, std::ios::binary) << content;
    return scratch_ / name;
  }
  std::string out() { return scratch_ / "result"; }
  void expect_sentence(const Ran& ran, int code, const std::string& about) {
    EXPECT_EQ(ran.exit_code, code) << ran.err;
    EXPECT_NE(ran.err.find(about), std::string::npos) << ran.err;
  }

  // All that a run starts carries a path below the scratch folder on its command line, where TMPDIR names
  // that.
  int processes_of_ours() const {
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
      const std::string words = read_file(entry.path() / "cmdline");
      if (words.find(scratch_.path().string()) != std::string::npos) ++count;
    }
    return count;
  }
  int temporary_folders() const {
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(scratch_.path())) {
      if (entry.path().filename().string().starts_with("skinframe-run-")) ++count;
    }
    return count;
  }

  Scratch scratch_;
};

TEST_F(Answers, RunMakesFilesThatTheCheckSaysYesTo) {
  const Ran ran = skinframe({"run", sample("egg"), "--printer", "sinterstation-hiq", "--printer",
                             "makerbot-replicator-2", "--size", "60", "--skin-nodes", "80", "--out", out()});
  ASSERT_EQ(ran.exit_code, 0) << ran.err;
  const Ran check = skinframe({"check", out()});
  EXPECT_EQ(check.exit_code, 0) << check.out << check.err;
  const Ran render = skinframe({"render", out(), "--size", "200", "--printer", "makerbot-replicator-2"});
  EXPECT_EQ(render.exit_code, 0) << render.err;
  for (const char* picture : {"frame.png", "radii.png", "lengths.png", "cutaway.png"})
    EXPECT_NE(render.out.find(out() + "/makerbot-replicator-2/" + picture + "\n"), std::string::npos)
        << render.out;
  expect_sentence(skinframe({"render", out() + "-not"}), 3, "there is no such folder");
  expect_sentence(skinframe({"render", out(), "--size", "9"}), 2, "--size");
  EXPECT_NE(check.out.find("makerbot-replicator-2: yes"), std::string::npos) << check.out;
}

TEST_F(Answers, OnePrinterTooSmallLeavesTheOthersResult) {
  const Ran ran =
      skinframe({"run", sample("egg"), "--printer", "sinterstation-hiq", "--printer", "makerbot-replicator-2",
                 "--size", "200", "--skin-nodes", "100", "--out", out()});
  EXPECT_EQ(ran.exit_code, 8) << ran.err;
  EXPECT_EQ(skinframe({"check", out()}).exit_code, 0);
}

TEST_F(Answers, TooLargeForTheOnlyTray) {
  expect_sentence(skinframe({"run", sample("egg"), "--printer", "makerbot-replicator-2", "--size", "200",
                             "--out", out()}),
                  3, "tray");
}

TEST_F(Answers, MissingFile) {
  expect_sentence(skinframe({"run", "no-such-file.stl", "--printer", "sinterstation-hiq", "--out", out()}), 3,
                  "no-such-file.stl");
}

TEST_F(Answers, FileThatIsNoMesh) {
  expect_sentence(skinframe({"run", write("notes.stl", "shopping list: bread, milk\n"), "--printer",
                             "sinterstation-hiq", "--out", out()}),
                  3, "neither ASCII STL");
}

TEST_F(Answers, EmptyFileAndEmptyMesh) {
  expect_sentence(
      skinframe({"run", write("empty.stl", ""), "--printer", "sinterstation-hiq", "--out", out()}), 3,
      "empty");
  const Ran ran = skinframe({"run", write("nothing.stl", "solid nothing\nendsolid nothing\n"), "--printer",
                             "sinterstation-hiq", "--out", out()});
  EXPECT_EQ(ran.exit_code, 3) << ran.err;
}

TEST_F(Answers, UnknownPrinterNamesTheKnownOnes) {
  const Ran ran = skinframe({"run", sample("egg"), "--printer", "teapot", "--out", out()});
  expect_sentence(ran, 2, "teapot");
  EXPECT_NE(ran.err.find("sinterstation-hiq"), std::string::npos) << ran.err;
}

TEST_F(Answers, WrongOptionAndOptionOutOfRange) {
  expect_sentence(
      skinframe({"run", sample("egg"), "--printer", "sinterstation-hiq", "--colour", "red", "--out", out()}),
      2, "--colour");
  expect_sentence(skinframe({"run", sample("egg"), "--printer", "sinterstation-hiq", "--load",
                             "side:nowhere:1,2,3", "--out", out()}),
                  2, "nowhere");
  EXPECT_EQ(
      skinframe({"run", sample("egg"), "--printer", "sinterstation-hiq", "--size", "-3", "--out", out()})
          .exit_code,
      2);
}

TEST_F(Answers, ServerNotRunning) {
  expect_sentence(skinframe({"--server", "127.0.0.1:1", "list"}), 7, "127.0.0.1:1");
}

TEST_F(Answers, ALoadThatCannotBeCarriedIsInfeasibleWithTheBestReachableValue) {
  const Ran ran = skinframe({"run", sample("egg"), "--printer", "sinterstation-hiq", "--size", "60",
                             "--skin-nodes", "60", "--load", "side:top:5000,0,0", "--out", out()});
  expect_sentence(ran, 4, "mm");
}

TEST_F(Answers, ABodyThatDoesNotStandCannotBeRequiredTo) {
  // An egg laid on its side touches the plate along a line's width only.
  const Ran ran = skinframe({"run", sample("hanging-ball"), "--printer", "sinterstation-hiq", "--size", "80",
                             "--skin-nodes", "120", "--up", "x", "--balance", "require", "--out", out()});
  EXPECT_EQ(ran.exit_code, 4) << ran.err;
  EXPECT_NE(ran.err.find("balance"), std::string::npos) << ran.err;
}

TEST_F(Answers, CtrlCCancelsAndLeavesNoProcessBehind) {
  Process process({binary("skinframe"), "run", sample("hanging-ball"), "--printer", "sinterstation-hiq",
                   "--size", "200", "--out", out()},
                  scratch_ / "interrupted", {"TMPDIR=" + scratch_.path().string()});
  // The program, its server, its worker and the job's process.
  ASSERT_TRUE(eventually([&] { return processes_of_ours() == 4 || !process.running(); })) << process.err();
  ASSERT_TRUE(
      eventually([&] { return process.err().find("skin") != std::string::npos || !process.running(); }));
  EXPECT_EQ(temporary_folders(), 1);
  process.signal(SIGINT);
  EXPECT_EQ(process.wait(Seconds(20)), 6) << process.err();
  EXPECT_TRUE(eventually([&] { return processes_of_ours() == 0; }, Seconds(10))) << processes_of_ours();
  EXPECT_EQ(temporary_folders(), 0);
}

}  // namespace
}  // namespace skinframe::integration
