// SPDX-License-Identifier: Apache-2.0
// The program itself, started as a user starts it; server and worker are shell scripts where a verb needs
// them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>

#include "client/call/retry.h"
#include "tests/client/fake/fake_server.h"
#include "tests/fixture/temporary_folder.h"

namespace skinframe::client {
namespace {

using testing::HasSubstr;
using testing::Not;

struct Ran {
  int code = -1;
  std::string out, err;
};

class Program : public fake::FakeServer {
 protected:
  // words as a shell takes them
  Ran run(const std::string& words, const std::string& program = SKINFRAME_PROGRAM) {
    const std::string command = "cd " + folder_.path().string() + " && env -u SKINFRAME_SERVER " +
                                environment_ + " " + program + " " + words + " >out.txt 2>err.txt </dev/null";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, folder_.read("out.txt"), folder_.read("err.txt")};
  }
  // A copy of the program with server and worker beside it that are scripts.
  std::string install(const std::string& server, const std::string& worker) {
    std::filesystem::create_directory(folder_.path() / "bin");
    std::filesystem::copy_file(SKINFRAME_PROGRAM, folder_.path() / "bin" / "skinframe");
    folder_.script("bin/skinframe-server", server);
    folder_.script("bin/skinframe-worker", worker);
    return folder_.path() / "bin" / "skinframe";
  }
  std::string mesh() { return folder_.write("mesh.stl", "mesh"); }

  test::TemporaryFolder folder_;
  std::string environment_;
};

TEST_F(Program, AloneItTeachesAndSaysWrongUsage) {
  const Ran ran = run("");
  EXPECT_EQ(ran.code, 2);
  EXPECT_THAT(ran.err, HasSubstr("skinframe run fish.obj"));
}

TEST_F(Program, EveryVerbTeachesWithAnExample) {
  for (const char* verb :
       {"run", "submit", "watch", "get", "list", "cancel", "download", "printers", "materials", "delete",
        "sample", "check", "solve-frame", "calibrate", "render", "doctor", "completion"}) {
    const Ran ran = run(std::string(verb) + " --help");
    EXPECT_EQ(ran.code, 0) << verb;
    EXPECT_THAT(ran.out, HasSubstr(std::string("  skinframe ") + verb)) << verb;
  }
  EXPECT_EQ(run("--version").code, 0);
}

TEST_F(Program, BashCompletesVerbsOptionsAndNothingThatIsNone) {
  folder_.write("try.sh", run("completion").out + R"(
complete_words() {
  COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); COMPREPLY=()
  _skinframe; echo "${COMPREPLY[*]}"
}
complete_words skinframe ca
complete_words skinframe --server farm:1 --json sub
complete_words skinframe submit m.stl --warm
complete_words skinframe printers s
complete_words skinframe submit mesh
)");
  const Ran ran = run("try.sh", "bash");
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_EQ(ran.out, "cancel calibrate\nsubmit\n--warm-start\nshow\n\n") << ran.err;
}

TEST_F(Program, TheServersAddressIsTakenFromCommandLineFileOrEnvironment) {
  const std::string file = folder_.write("client.conf", "server = 127.0.0.1:2\n");
  environment_ = "SKINFRAME_SERVER=127.0.0.1:3";
  EXPECT_THAT(run("list").err, HasSubstr("127.0.0.1:3"));
  EXPECT_THAT(run("--config " + file + " list").err, HasSubstr("127.0.0.1:2"));
  EXPECT_THAT(run("--config " + file + " --server 127.0.0.1:1 list").err, HasSubstr("127.0.0.1:1"));
  folder_.write("client.conf", "sever = x\n");
  EXPECT_EQ(run("--config " + file + " list").code, 2);
}

TEST_F(Program, DoctorSaysWhereNoServerIsAndEndsWithItsCode) {
  const Ran ran = run("doctor --server 127.0.0.1:1");
  EXPECT_EQ(ran.code, 7);
  EXPECT_THAT(ran.out, HasSubstr("WRONG server"));
  EXPECT_THAT(run("doctor --json --server 127.0.0.1:1").out, HasSubstr("\"well\": false"));
}

TEST_F(Program, WrongUsageIsTwoAndNamesTheWord) {
  EXPECT_THAT(run("run mesh.stl --printer p --out o --colour red").err, HasSubstr("--colour"));
  EXPECT_EQ(run("run mesh.stl --printer p --out o --colour red").code, 2);
  EXPECT_EQ(run("frobnicate").code, 2);
  EXPECT_EQ(run("run " + mesh() + " --out o").code, 2);
  EXPECT_EQ(run("run " + mesh() + " --printer p --out o --load side:nowhere:1,2,3").code, 2);
  EXPECT_EQ(run("run " + mesh() + " --printer p --out o --up sideways").code, 2);
  EXPECT_EQ(run("submit " + mesh() + " --printer p --out o").code, 2);
  EXPECT_EQ(run("list --state lost").code, 2);
}

TEST_F(Program, AMissingMeshIsThreeAndNamesIt) {
  for (const char* verb : {"run", "submit"}) {
    const Ran ran =
        run(std::string(verb) + " no-such.stl --printer p" + (verb == std::string("run") ? " --out o" : ""));
    EXPECT_EQ(ran.code, 3) << ran.err;
    EXPECT_THAT(ran.err, HasSubstr("no-such.stl"));
  }
}

TEST_F(Program, NoServerIsSevenAndNamesAddressAndRemedy) {
  const Ran ran = run("--server 127.0.0.1:1 list");
  EXPECT_EQ(ran.code, 7);
  EXPECT_THAT(ran.err, testing::AllOf(HasSubstr("127.0.0.1:1"), HasSubstr("skinframe-server --data")));
  EXPECT_EQ(run("list --server 127.0.0.1:1").code, 7) << "global options may stand behind the verb";
}

TEST_F(Program, AnUnknownJobIsNine) { EXPECT_EQ(run("--server " + address_ + " watch nobody").code, 9); }

TEST_F(Program, TwoWatchersPrintTheSameLinesWheneverTheyStart) {
  jobs_.job.set_job_id("j1");
  jobs_.add_state(v1::JOB_STATE_QUEUED);
  for (int i = 1; i < 50; ++i) jobs_.add_progress("size", i);
  jobs_.add_state(v1::JOB_STATE_SUCCEEDED);
  environment_ = "SKINFRAME_SERVER=" + address_;
  const Ran all = run("watch j1");
  EXPECT_EQ(all.code, 0) << all.err;
  const Ran later = run("watch j1 --from 20");
  EXPECT_THAT(all.out, testing::EndsWith(later.out));
  EXPECT_EQ(std::count(all.out.begin(), all.out.end(), '\n'), 51);
  EXPECT_EQ(std::count(later.out.begin(), later.out.end(), '\n'), 31);
}

TEST_F(Program, SubmitPrintsTheIdAloneAndAsJson) {
  jobs_.job.set_job_id("j1");
  environment_ = "SKINFRAME_SERVER=" + address_;
  EXPECT_EQ(run("submit " + mesh() + " --printer p").out, "j1\n");
  EXPECT_EQ(run("submit " + mesh() + " --printer p --json").out, "{\n  \"job_id\": \"j1\"\n}\n");
  EXPECT_EQ(jobs_.submissions.at(0).spec().mesh_name(), "mesh.stl");
}

TEST_F(Program, AFrameProblemIsToldByItsContentAndNeedsNoPrinter) {
  jobs_.job.set_job_id("j1");
  environment_ = "SKINFRAME_SERVER=" + address_;
  const std::string problem = folder_.write("problem.json", "{\"mechanics\": \"paper\"}");
  EXPECT_EQ(run("submit " + problem).out, "j1\n");
  const v1::JobSpec& spec = jobs_.submissions.at(0).spec();
  EXPECT_TRUE(spec.has_frame_problem_sha256());
  EXPECT_EQ(spec.mesh_name(), "problem.json");
  EXPECT_EQ(spec.options().ByteSizeLong(), 0u);
  const Ran mesh_alone = run("submit " + mesh());
  EXPECT_EQ(mesh_alone.code, 2);
  EXPECT_THAT(mesh_alone.err, HasSubstr("--printer is required"));
}

TEST_F(Program, AnEarlierJobToStartFromIsAField) {
  jobs_.job.set_job_id("j1");
  environment_ = "SKINFRAME_SERVER=" + address_;
  EXPECT_EQ(run("submit " + mesh() + " --printer p --warm-start j0").code, 0);
  EXPECT_EQ(jobs_.submissions.at(0).spec().warm_start_job_id(), "j0");
}

TEST_F(Program, SubmitWatchDownloadsAndTellsTheEndByItsExitCode) {
  jobs_.job.set_job_id("j1");
  jobs_.add_state(v1::JOB_STATE_FAILED);
  jobs_.job.set_reason(v1::REASON_INFEASIBLE);
  jobs_.job.set_detail("the displacement cannot be held");
  environment_ = "SKINFRAME_SERVER=" + address_;
  const Ran ran = run("submit " + mesh() + " --printer p --watch --out o");
  EXPECT_EQ(ran.code, 4);
  EXPECT_THAT(ran.err, HasSubstr("FAILED, INFEASIBLE: the displacement cannot be held"));
}

TEST_F(Program, LocalVerbsRunTheWorkerBesideUsAndHandItsExitCodeOn) {
  const std::string program = install("exit 9\n", "echo \"$@\"; exit 1\n");
  const Ran ran = run("check a-dir --deep", program);
  EXPECT_EQ(ran.code, 1);
  EXPECT_EQ(ran.out, "check a-dir --deep\n");
  environment_ = "SKINFRAME_WORKER=" + folder_.script("other-worker", "echo other; exit 0\n");
  EXPECT_EQ(run("sample --list", program).out, "other\n");
  environment_ = "SKINFRAME_WORKER=/nowhere/worker";
  EXPECT_EQ(run("sample --list", program).code, 5);
}

TEST_F(Program, RunStartsServerAndWorkerAndStopsThemAgain) {
  jobs_.job.set_job_id("j1");
  jobs_.add_state(v1::JOB_STATE_SUCCEEDED);
  const std::string pids = folder_.path() / "pids";
  // The script stands in for the server only in so far as it names the address of the one in this test.
  const std::string stay = "echo $$ >>" + pids + "; trap 'kill $!; exit 0' TERM; tail -f /dev/null & wait\n";
  const std::string program = install(
      "while [ \"$1\" != --port-file ]; do shift; done\necho " + address_ + " >\"$2\"\n" + stay, stay);
  const std::string temporary = folder_.path() / "tmp";
  std::filesystem::create_directory(temporary);
  environment_ = "TMPDIR=" + temporary;
  const Ran ran = run("run " + mesh() + " --printer p --out o", program);
  EXPECT_EQ(ran.code, 0) << ran.err;
  EXPECT_TRUE(std::filesystem::is_empty(temporary));
  std::istringstream in(folder_.read("pids"));
  for (std::string pid; in >> pid;) EXPECT_FALSE(std::filesystem::exists("/proc/" + pid)) << pid;
}

TEST_F(Program, AServerThatDiesIsToldInOneSentence) {
  jobs_.job.set_job_id("j1");
  jobs_.hang = true;
  const std::string gate = folder_.path() / "gate";
  ASSERT_EQ(::mkfifo(gate.c_str(), 0600), 0);
  const std::string program =
      install("while [ \"$1\" != --port-file ]; do shift; done\necho " + address_ + " >\"$2\"; read go <" +
                  gate + "; echo 'the disk is full' >&2; exit 1\n",
              "echo go >" + gate + "; trap 'kill $!; exit 0' TERM; tail -f /dev/null & wait\n");
  environment_ = "TMPDIR=" + folder_.path().string();
  const Ran ran = run("run " + mesh() + " --printer p --out o", program);
  EXPECT_EQ(ran.code, 5) << ran.err;
  EXPECT_THAT(ran.err, HasSubstr("skinframe: the embedded server ended: the disk is full\n"));
  EXPECT_EQ(ran.err.find("skinframe: "), ran.err.rfind("skinframe: ")) << ran.err;
}

TEST_F(Program, AMissingServerNamesNoFolderOfLogs) {
  const std::string program = install("exit 0\n", "exit 0\n");
  std::filesystem::remove(folder_.path() / "bin" / "skinframe-server");
  const Ran ran = run("run " + mesh() + " --printer p --out o", program);
  EXPECT_EQ(ran.code, 5) << ran.err;
  EXPECT_THAT(ran.err, Not(HasSubstr("The logs")));
}

TEST_F(Program, ASecondSignalIsHeardWhileTheCancellationHangs) {
  jobs_.job.set_job_id("j1");
  jobs_.hang = true;
  std::vector<std::string> words = {SKINFRAME_PROGRAM, "--server", address_, "submit", mesh(),
                                    "--printer",       "p",        "--watch"};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t pid = 0;
  ASSERT_EQ(::posix_spawn(&pid, words[0].c_str(), nullptr, nullptr, arguments.data(), environ), 0);
  const auto await = [&](const int& hanging) {
    std::unique_lock lock(jobs_.mutex);
    return jobs_.called.wait_for(lock, std::chrono::seconds(20), [&] { return hanging > 0; });
  };
  EXPECT_TRUE(await(jobs_.hanging_watches));
  ::kill(pid, SIGTERM);
  EXPECT_TRUE(await(jobs_.hanging_cancels));
  const auto second = std::chrono::steady_clock::now();
  ::kill(pid, SIGTERM);
  int status = 0;
  ASSERT_EQ(::waitpid(pid, &status, 0), pid);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 6);
  EXPECT_LT(std::chrono::steady_clock::now() - second, RetryPolicy().deadline / 2);
}

TEST_F(Program, AServerThatDoesNotStartIsFiveAndItsLogStays) {
  const std::string program = install("echo 'the disk is full' >&2; exit 1\n", "exit 0\n");
  environment_ = "TMPDIR=" + folder_.path().string();
  const Ran ran = run("run " + mesh() + " --printer p --out o", program);
  EXPECT_EQ(ran.code, 5);
  EXPECT_THAT(ran.err, testing::AllOf(HasSubstr("the disk is full"), HasSubstr("skinframe-run-")));
}

}  // namespace
}  // namespace skinframe::client
