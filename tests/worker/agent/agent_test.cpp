// SPDX-License-Identifier: GPL-3.0-or-later
// The whole agent against a server of the generated services in this process; the job is a shell script.
#include "worker/agent/agent.h"

#include <gmock/gmock.h>
#include <google/protobuf/util/time_util.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <thread>

#include "tests/client/fake/fake_artifacts.h"
#include "tests/fixture/temporary_folder.h"
#include "tests/worker/agent/fake_worker_service.h"
#include "worker/agent/artifact_transfer.h"

namespace skinframe::agent {
namespace {

using google::protobuf::util::TimeUtil;

class AgentTest : public testing::Test {
 protected:
  void SetUp() override {
    grpc::ServerBuilder builder;
    builder.AddListeningPort("127.0.0.1:0", grpc::InsecureServerCredentials(), &port_);
    builder.RegisterService(&workers_);
    builder.RegisterService(&artifacts_);
    server_ = builder.BuildAndStart();
    ASSERT_NE(server_, nullptr);
    artifacts_.complete[kMeshHash] = "mesh";
    options_.work_root = folder_.path() / "work";
    options_.worker_name = "test";
  }

  void TearDown() override {
    stop_agent();
    server_->Shutdown();
  }

  void start_agent(const std::string& script) {
    options_.self_executable = folder_.script("job.sh", script);
    const auto channel =
        grpc::CreateChannel("127.0.0.1:" + std::to_string(port_), grpc::InsecureChannelCredentials());
    agent_ = std::thread([this, channel] {
      const Status ended = run_agent_until(options_, channel, stop_.get_token(), drain_.get_token());
      EXPECT_TRUE(ended.ok());
    });
  }

  void stop_agent() {
    stop_.request_stop();
    if (agent_.joinable()) agent_.join();
  }

  void assign(std::int64_t heartbeat_ms = 20) {
    v1::Assignment a;
    a.set_job_id("job-1");
    a.set_fencing_token(7);
    a.set_attempt(1);
    a.mutable_spec()->set_mesh_sha256(kMeshHash);
    a.mutable_spec()->add_printers();
    a.add_printers()->set_process(v1::PRINT_PROCESS_POWDER);
    a.add_materials();
    if (!checkpoint_.empty()) a.mutable_checkpoint()->set_sha256(checkpoint_);
    *a.mutable_heartbeat_interval() = TimeUtil::MillisecondsToDuration(heartbeat_ms);
    *a.mutable_lease_duration() = TimeUtil::SecondsToDuration(10);
    const std::lock_guard lock(workers_.mutex);
    workers_.queue.push_back(a);
    workers_.changed.notify_all();
  }

  template <class Predicate>
  bool wait_for(Predicate predicate) {
    std::unique_lock lock(workers_.mutex);
    return workers_.changed.wait_for(lock, std::chrono::seconds(20), predicate);
  }

  v1::CompleteRequest completion() {
    EXPECT_TRUE(wait_for([&] { return !workers_.completions.empty(); }));
    const std::lock_guard lock(workers_.mutex);
    return workers_.completions.empty() ? v1::CompleteRequest() : workers_.completions.front();
  }

  // SHA-256 of "mesh"
  const std::string kMeshHash = [] {
    const test::TemporaryFolder folder;
    std::ofstream(folder.path() / "m") << "mesh";
    return digest_file(folder.path() / "m")->sha256;
  }();
  test::TemporaryFolder folder_;
  fake::FakeArtifacts artifacts_;
  std::string checkpoint_;  // of the assignment
  FakeWorkerService workers_;
  AgentOptions options_;
  int port_ = 0;
  std::unique_ptr<grpc::Server> server_;
  std::stop_source stop_;
  std::stop_source drain_;
  std::thread agent_;
};

constexpr char kGoodJob[] = R"sh(
[ "$1" = run-job ] && [ "$(cat $2/mesh)" = mesh ] && [ -s $2/job.json ] || exit 9
echo '{"progress": {"stage": "size", "iteration": 1, "total_volume_mm3": 100}}'
echo 'garbage that no agent should fall over'
mkdir -p $2/out/p-1; printf report > $2/out/report.json; printf solid > $2/out/p-1/skin-frame.stl
echo '{"state": "SUCCEEDED", "reason": "NONE", "printers": [{"printer": "p-1", "state": "SUCCEEDED"}]}' > $2/outcome.json
)sh";

TEST_F(AgentTest, AJobGoesFromLeaseToResult) {
  assign();
  start_agent(kGoodJob);
  const auto done = completion();
  EXPECT_EQ(done.fencing_token(), 7);
  EXPECT_EQ(done.state(), v1::JOB_STATE_SUCCEEDED) << done.detail();
  ASSERT_EQ(done.printers_size(), 1);
  ASSERT_EQ(done.files_size(), 2);
  EXPECT_EQ(done.files(0).path(), "p-1/skin-frame.stl");
  EXPECT_EQ(done.files(1).path(), "report.json");
  EXPECT_EQ(artifacts_.complete[done.files(1).sha256()], "report");
  const std::lock_guard lock(workers_.mutex);
  ASSERT_FALSE(workers_.heartbeats.empty());
  bool told = false;
  for (const auto& beat : workers_.heartbeats) told = told || beat.progress_size() > 0;
  EXPECT_TRUE(told) << "progress was lost";
}

TEST_F(AgentTest, ACheckpointGoesToTheServerWhileTheJobRuns) {
  assign();
  const auto go = (folder_.path() / "go").string();
  start_agent(
      "printf mesh > $2/checkpoint; echo '{\"checkpoint\": {\"stage\": \"size\"}}'\n"
      "while [ ! -e " +
      go + " ]; do :; done\n" + kGoodJob);
  EXPECT_TRUE(wait_for([&] { return !workers_.checkpoints.empty(); }));
  std::ofstream(go) << "go";
  EXPECT_EQ(completion().state(), v1::JOB_STATE_SUCCEEDED);
  const v1::CheckpointRequest& sent = workers_.checkpoints.at(0);
  EXPECT_EQ(sent.fencing_token(), 7);
  EXPECT_EQ(sent.checkpoint().sha256(), kMeshHash);
  EXPECT_EQ(sent.checkpoint().size_bytes(), 4);
  EXPECT_EQ(sent.checkpoint().stage(), "size");
}

TEST_F(AgentTest, TheCheckpointOfAnEarlierAttemptIsGivenToTheJob) {
  checkpoint_ = kMeshHash;  // any artifact that is there
  assign();
  start_agent(std::string("[ \"$(cat $2/resume)\" = mesh ] || exit 8\n") + kGoodJob);
  EXPECT_EQ(completion().state(), v1::JOB_STATE_SUCCEEDED);
}

TEST_F(AgentTest, ACheckpointThatIsGoneIsDoneWithoutAndSaidSo) {
  checkpoint_ = std::string(64, 'c');
  assign();
  start_agent(std::string("[ ! -e $2/resume ] || exit 8\n") + kGoodJob);
  EXPECT_EQ(completion().state(), v1::JOB_STATE_SUCCEEDED);
  const std::lock_guard lock(workers_.mutex);
  bool told = false;
  for (const auto& beat : workers_.heartbeats)
    for (const auto& progress : beat.progress()) told = told || !progress.note().empty();
  EXPECT_TRUE(told);
}

TEST_F(AgentTest, NothingOfAJobStaysOnTheDisk) {
  assign();
  start_agent(kGoodJob);
  completion();
  stop_agent();
  EXPECT_TRUE(std::filesystem::is_empty(options_.work_root));
}

TEST_F(AgentTest, WhatAKilledAgentLeftGoesAtTheNextStartAndALivingOnesFolderStays) {
  std::filesystem::create_directories(options_.work_root / "agent-dead" / "job-3");
  std::ofstream(options_.work_root / "agent-dead" / "lock").flush();
  assign();
  start_agent(kGoodJob);
  completion();
  EXPECT_FALSE(std::filesystem::exists(options_.work_root / "agent-dead"));
}

TEST_F(AgentTest, ACrashedJobIsHandedBackForAnotherAttempt) {
  assign();
  start_agent("echo 'triangle 41' >&2; kill -SEGV $$\n");
  const auto done = completion();
  EXPECT_EQ(done.state(), v1::JOB_STATE_FAILED);
  EXPECT_EQ(done.reason(), v1::REASON_CRASHED);
  EXPECT_TRUE(done.retryable());
  EXPECT_THAT(done.detail(),
              testing::AllOf(testing::HasSubstr("SIGSEGV"), testing::HasSubstr("triangle 41")));
}

TEST_F(AgentTest, ACancelledJobIsStoppedAndCompletedAsCancelled) {
  workers_.cancel = true;
  assign();
  start_agent("while :; do :; done\n");
  EXPECT_EQ(completion().state(), v1::JOB_STATE_CANCELLED);
}

TEST_F(AgentTest, ACancellationArrivesHoweverRarelyTheLeaseNeedsProlonging) {
  assign(3'600'000);
  start_agent("while :; do :; done\n");
  ASSERT_TRUE(wait_for([&] { return !workers_.heartbeats.empty(); }));
  {
    const std::lock_guard lock(workers_.mutex);
    workers_.cancel = true;
  }
  EXPECT_EQ(completion().state(), v1::JOB_STATE_CANCELLED);
}

TEST_F(AgentTest, AJobWhoseLeaseIsLostIsStoppedAndItsResultDropped) {
  workers_.take_lease_away = true;
  assign();
  start_agent("touch " + (folder_.path() / "started").string() + "; while :; do :; done\n");
  ASSERT_TRUE(wait_for([&] { return !workers_.heartbeats.empty(); }));
  {
    const std::lock_guard lock(workers_.mutex);
    workers_.take_lease_away = false;
  }
  assign();  // the slot is free again: the next lease is asked for only after the first job's end
  ASSERT_TRUE(wait_for([&] { return workers_.queue.empty(); }));
  const std::lock_guard lock(workers_.mutex);
  EXPECT_TRUE(workers_.completions.empty());
}

TEST_F(AgentTest, AStoppedWorkerHandsItsJobBackAtOnce) {
  assign();
  start_agent("while :; do :; done\n");
  ASSERT_TRUE(wait_for([&] { return !workers_.heartbeats.empty(); }));
  stop_agent();
  const auto done = completion();
  EXPECT_EQ(done.state(), v1::JOB_STATE_CANCELLED);
  EXPECT_FALSE(done.retryable());
  EXPECT_EQ(done.detail(), "worker stopped");
}

TEST_F(AgentTest, ADrainedWorkerFinishesItsJobAndTakesNoMore) {
  const std::string go_on = (folder_.path() / "go-on").string();
  assign();
  start_agent("while [ ! -e " + go_on + " ]; do :; done\n" + kGoodJob);
  ASSERT_TRUE(wait_for([&] { return !workers_.heartbeats.empty(); }));
  drain_.request_stop();
  assign();  // nobody takes it
  std::ofstream(go_on).flush();
  EXPECT_EQ(completion().state(), v1::JOB_STATE_SUCCEEDED);
  agent_.join();
  const std::lock_guard lock(workers_.mutex);
  EXPECT_EQ(workers_.queue.size(), 1u);
  EXPECT_EQ(workers_.completions.size(), 1u);
}

TEST_F(AgentTest, ADrainedWorkerWithoutAJobEndsAtOnce) {
  start_agent(kGoodJob);
  ASSERT_TRUE(wait_for([&] { return workers_.asked > 0; }));
  drain_.request_stop();
  agent_.join();
}

TEST_F(AgentTest, AWorkerShowsItsLeaseWithEveryFile) {
  assign();
  start_agent(kGoodJob);
  completion();
  stop_agent();
  const std::lock_guard lock(artifacts_.mutex);
  EXPECT_FALSE(artifacts_.leases_shown.empty());
  for (const std::string& lease : artifacts_.leases_shown) EXPECT_EQ(lease, "job-1 7");
}

// The server's threads in this process have no signal blocked, as a library's have not.
TEST_F(AgentTest, AStopSignalEndsTheAgentCleanlyWhicheverThreadItReaches) {
  options_.server_address = "127.0.0.1:" + std::to_string(port_);
  options_.self_executable = folder_.script("job.sh", "while :; do :; done\n");
  assign();
  int code = -1;
  agent_ = std::thread([&] { code = run_agent(options_); });
  ASSERT_TRUE(wait_for([&] { return !workers_.heartbeats.empty(); }));
  // The first drains, a further one hands back; two that come at once count as one.
  const auto ended = [&] { return !workers_.completions.empty(); };
  do {
    ::kill(::getpid(), SIGTERM);
    std::unique_lock lock(workers_.mutex);
    workers_.changed.wait_for(lock, std::chrono::milliseconds(200), ended);
  } while (!ended());
  agent_.join();
  EXPECT_EQ(code, 0);
  EXPECT_EQ(completion().detail(), "worker stopped");
}

TEST_F(AgentTest, ACompletionIsSentUntilTheServerTakesIt) {
  for (const auto code : {grpc::StatusCode::UNAVAILABLE, grpc::StatusCode::RESOURCE_EXHAUSTED}) {
    {
      const std::lock_guard lock(workers_.mutex);
      workers_.refusal = code;
      workers_.refuse_completions = 2;
      workers_.completions.clear();
    }
    assign();
    if (!agent_.joinable()) start_agent(kGoodJob);
    EXPECT_EQ(completion().state(), v1::JOB_STATE_SUCCEEDED);
  }
}

TEST_F(AgentTest, HeartbeatsKeepTheLeaseWhileTheServerDoesNotTakeTheCompletion) {
  workers_.refusal = grpc::StatusCode::RESOURCE_EXHAUSTED;
  workers_.refuse_completions = 3;
  assign();
  start_agent(kGoodJob);
  EXPECT_EQ(completion().state(), v1::JOB_STATE_SUCCEEDED);
  const std::lock_guard lock(workers_.mutex);
  EXPECT_GE(workers_.beats_after_refusal, 3);
}

TEST(AgentOptions, OutOfRangeIsNamed) {
  AgentOptions options;
  EXPECT_TRUE(options.validate().ok());
  options.tls_cert = "worker.crt";
  EXPECT_THAT(options.validate().error().message, testing::HasSubstr("key"));
  options.tls_cert.clear();
  options.slots = 0;
  EXPECT_THAT(options.validate().error().message, testing::HasSubstr("slots"));
  options.slots = 1;
  options.memory_limit_mb = 5;
  EXPECT_THAT(options.validate().error().message, testing::HasSubstr("memory limit"));
}

}  // namespace
}  // namespace skinframe::agent
