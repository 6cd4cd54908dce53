// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/agent/child_process.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "worker/agent/supervise.h"

namespace skinframe::agent {
namespace {

struct ScriptRun {
  ChildExit exit;
  std::size_t dropped = 0;
  std::vector<std::string> out, err;
};

ScriptRun run_script(const std::string& script, SuperviseOptions options = {},
                     std::optional<std::uint64_t> address_space = std::nullopt) {
  auto child = ChildProcess::start({"/bin/sh", {"skinframe-worker", "-c", script}, address_space});
  EXPECT_TRUE(child.ok());
  ScriptRun run;
  options.on_stdout_line = [&, then = options.on_stdout_line](std::string_view line) {
    run.out.emplace_back(line);
    if (then) then(line);
  };
  options.on_stderr_line = [&](std::string_view line) { run.err.emplace_back(line); };
  const Supervised ended = supervise(child.value(), options);
  run.exit = ended.exit;
  run.dropped = ended.dropped_lines;
  return run;
}

TEST(ChildProcess, GoesByTheNameThatItIsGiven) {
  EXPECT_THAT(run_script("echo $0").out, testing::ElementsAre("skinframe-worker"));
}

TEST(ChildProcess, EveryLineArrivesInOrderAndTheExitCodeWithIt) {
  const ScriptRun run = run_script("echo one; echo two >&2; printf three; exit 7");
  EXPECT_THAT(run.out, testing::ElementsAre("one", "three"));
  EXPECT_THAT(run.err, testing::ElementsAre("two"));
  EXPECT_EQ(run.exit.exit_code, 7);
  EXPECT_EQ(run.exit.signal, 0);
}

TEST(ChildProcess, AFloodOfLinesIsNotLost) {
  const ScriptRun run = run_script("i=0; while [ $i -lt 20000 ]; do echo line-$i; i=$((i+1)); done");
  ASSERT_EQ(run.out.size(), 20000u);
  EXPECT_EQ(run.out.back(), "line-19999");
}

TEST(ChildProcess, TheSignalThatKilledItIsTold) {
  const ScriptRun run = run_script("kill -SEGV $$");
  EXPECT_EQ(run.exit.signal, SIGSEGV);
  EXPECT_EQ(signal_name(run.exit.signal), "SIGSEGV");
}

TEST(ChildProcess, AProgramThatIsNotThereIsAnErrorThatNamesIt) {
  const auto child =
      ChildProcess::start({"/nowhere/skinframe-worker", {"skinframe-worker", "run-job"}, std::nullopt});
  ASSERT_FALSE(child.ok());
  EXPECT_EQ(child.error().kind, ErrorKind::kIo);
  EXPECT_THAT(child.error().message, testing::HasSubstr("/nowhere/skinframe-worker"));
}

TEST(ChildProcess, InheritsNoDescriptorOfOurs) {
  const int leak = ::open("/dev/null", O_RDONLY);  // a library that forgot close-on-exec
  ASSERT_GT(leak, 2);
  const ScriptRun run =
      run_script("if [ -e /proc/self/fd/" + std::to_string(leak) + " ]; then echo leaked; fi");
  ::close(leak);
  EXPECT_THAT(run.out, testing::IsEmpty());
}

TEST(ChildProcess, SignalsThatTheAgentBlocksReachTheChild) {
  sigset_t blocked, before;
  sigemptyset(&blocked);
  sigaddset(&blocked, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &blocked, &before);
  std::stop_source stop;
  SuperviseOptions options;
  options.stop = stop.get_token();
  options.on_stdout_line = [&](std::string_view) { stop.request_stop(); };
  const ScriptRun run = run_script("echo ready; while :; do :; done", options);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  EXPECT_EQ(run.exit.signal, SIGTERM);
}

TEST(ChildProcess, AChildThatIgnoresTermIsKilled) {
  std::stop_source stop;
  SuperviseOptions options;
  options.stop = stop.get_token();
  options.kill_after = std::chrono::milliseconds(20);
  options.on_stdout_line = [&](std::string_view) { stop.request_stop(); };
  const ScriptRun run = run_script("trap '' TERM; echo ready; while :; do :; done", options);
  EXPECT_EQ(run.exit.signal, SIGKILL);
}

TEST(ChildProcess, AChildThatObeysTermHasItsLastWord) {
  std::stop_source stop;
  SuperviseOptions options;
  options.stop = stop.get_token();
  options.on_stdout_line = [&](std::string_view) { stop.request_stop(); };
  const ScriptRun run = run_script("trap 'echo bye; exit 0' TERM; echo ready; while :; do :; done", options);
  EXPECT_EQ(run.exit.signal, 0);
  EXPECT_THAT(run.out, testing::ElementsAre("ready", "bye"));
}

TEST(ChildProcess, AGrandchildThatKeepsThePipeOpenDoesNotHoldUsUp) {
  const ScriptRun run = run_script("(trap '' TERM; while :; do :; done) & echo ready");
  EXPECT_THAT(run.out, testing::ElementsAre("ready"));
}

TEST(ChildProcess, TheAddressSpaceIsLimited) {
  const ScriptRun run = run_script("ulimit -v", {}, std::uint64_t{256} << 20);
  EXPECT_THAT(run.out, testing::ElementsAre("262144"));
}

TEST(ChildProcess, ALineWithoutEndCostsNoMemoryAndIsDropped) {
  const ScriptRun run = run_script("head -c 3000000 /dev/zero | tr '\\0' x; echo; echo after");
  EXPECT_THAT(run.out, testing::ElementsAre("after"));
  EXPECT_EQ(run.dropped, 1u);
}

}  // namespace
}  // namespace skinframe::agent
