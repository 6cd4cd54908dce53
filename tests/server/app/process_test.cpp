// SPDX-License-Identifier: Apache-2.0
// The real program: killed without warning, started again, asked to stop.
#include <gmock/gmock.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <future>
#include <mutex>
#include <set>
#include <thread>

#include "skinframe/v1/artifact.grpc.pb.h"
#include "skinframe/v1/job.grpc.pb.h"
#include "skinframe/v1/worker.grpc.pb.h"
#include "tests/server/app/put_artifact.h"
#include "tests/server/app/server_process.h"
#include "tests/server/fixture/temporary_folder.h"

namespace skinframe::server {
namespace {

struct Client {
  explicit Client(const std::string& address)
      : channel(grpc::CreateChannel(address, grpc::InsecureChannelCredentials())),
        jobs(v1::JobService::NewStub(channel)),
        artifacts(v1::ArtifactService::NewStub(channel)),
        workers(v1::WorkerService::NewStub(channel)) {}

  std::shared_ptr<grpc::Channel> channel;
  std::unique_ptr<v1::JobService::Stub> jobs;
  std::unique_ptr<v1::ArtifactService::Stub> artifacts;
  std::unique_ptr<v1::WorkerService::Stub> workers;
};

v1::SubmitJobRequest job_of(const std::string& mesh, const std::string& request_id) {
  v1::SubmitJobRequest request;
  request.set_request_id(request_id);
  request.mutable_spec()->set_mesh_sha256(mesh);
  request.mutable_spec()->add_printers()->set_printer_id("sinterstation-hiq");
  return request;
}

class ServerProcessTest : public testing::Test {
 protected:
  // A second program that is to listen there over that folder ends with the code and one line that has the
  // words.
  void expect_refused(const std::string& listen, const char* data, int expected, const std::string& words) {
    const auto [code, text] =
        ServerProcess::run({"--listen", listen, "--data", (folder_.path() / data).string()}, folder_.path());
    EXPECT_EQ(code, expected);
    EXPECT_NE(text.find(words), std::string::npos) << text;
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
  }

  TemporaryFolder folder_;
  ServerProcess process_{folder_.path()};
};

TEST_F(ServerProcessTest, NothingAcknowledgedIsMissingAfterAKill) {
  std::string address = process_.start();
  ASSERT_FALSE(address.empty());
  std::set<std::string> acknowledged;
  std::mutex mutex;
  {
    Client client(address);
    const std::string mesh = put_artifact(*client.artifacts, "a mesh");
    std::vector<std::thread> submitters;
    for (int t = 0; t < 4; ++t) {
      submitters.emplace_back([&, t] {
        for (int i = 0;; ++i) {
          grpc::ClientContext context;
          set_deadline(context);
          v1::SubmitJobResponse response;
          const auto request = job_of(mesh, std::to_string(t) + "-" + std::to_string(i));
          if (!client.jobs->SubmitJob(&context, request, &response).ok()) return;  // the server is dead
          const std::lock_guard lock(mutex);
          acknowledged.insert(response.job().job_id());
        }
      });
    }
    for (bool enough = false; !enough;) {
      std::this_thread::yield();
      const std::lock_guard lock(mutex);
      enough = acknowledged.size() >= 100;
    }
    EXPECT_EQ(process_.stop(SIGKILL), -SIGKILL);  // in the midst of further submissions
    for (std::thread& submitter : submitters) submitter.join();
  }
  address = process_.start();
  ASSERT_FALSE(address.empty());
  Client client(address);
  for (const std::string& id : acknowledged) {
    grpc::ClientContext context;
    set_deadline(context);
    v1::GetJobRequest request;
    request.set_job_id(id);
    v1::Job job;
    ASSERT_TRUE(client.jobs->GetJob(&context, request, &job).ok()) << id;
    EXPECT_EQ(job.state(), v1::JOB_STATE_QUEUED);
  }
}

TEST_F(ServerProcessTest, WatchAndWorkerGoOnAfterAKillAsIfNothingHadHappened) {
  std::string address = process_.start();
  ASSERT_FALSE(address.empty());
  v1::LeaseResponse lease;
  std::int64_t seen = 0;
  {
    Client client(address);
    v1::SubmitJobResponse submitted;
    grpc::ClientContext submit_context;
    ASSERT_TRUE(
        client.jobs
            ->SubmitJob(&submit_context, job_of(put_artifact(*client.artifacts, "a mesh"), ""), &submitted)
            .ok());
    v1::LeaseRequest request;
    request.set_worker_id("worker");
    request.set_instance_id("instance");
    request.mutable_wait()->set_seconds(10);
    grpc::ClientContext lease_context;
    ASSERT_TRUE(client.workers->Lease(&lease_context, request, &lease).ok());

    grpc::ClientContext watch_context;
    set_deadline(watch_context);
    v1::WatchJobRequest watch;
    watch.set_job_id(submitted.job().job_id());
    const auto reader = client.jobs->WatchJob(&watch_context, watch);
    v1::JobEvent event;
    while (seen < 2 && reader->Read(&event)) seen = event.sequence();
    process_.stop(SIGKILL);
    while (reader->Read(&event)) seen = event.sequence();
    EXPECT_EQ(reader->Finish().error_code(), grpc::StatusCode::UNAVAILABLE);
  }
  ASSERT_EQ(seen, 2);
  address = process_.start();
  ASSERT_FALSE(address.empty());
  Client client(address);
  v1::HeartbeatRequest beat;
  beat.set_job_id(lease.assignment().job_id());
  beat.set_fencing_token(lease.assignment().fencing_token());
  beat.add_progress()->set_stage("size");
  grpc::ClientContext beat_context;
  v1::HeartbeatResponse beaten;
  ASSERT_TRUE(client.workers->Heartbeat(&beat_context, beat, &beaten).ok());
  v1::CompleteRequest complete;
  complete.set_job_id(beat.job_id());
  complete.set_fencing_token(beat.fencing_token());
  complete.set_state(v1::JOB_STATE_SUCCEEDED);
  grpc::ClientContext complete_context;
  v1::CompleteResponse completed;
  ASSERT_TRUE(client.workers->Complete(&complete_context, complete, &completed).ok());

  grpc::ClientContext watch_context;
  set_deadline(watch_context);
  v1::WatchJobRequest watch;
  watch.set_job_id(beat.job_id());
  watch.set_after_sequence(seen);
  const auto reader = client.jobs->WatchJob(&watch_context, watch);
  v1::JobEvent event;
  while (reader->Read(&event)) EXPECT_EQ(event.sequence(), ++seen);
  EXPECT_TRUE(reader->Finish().ok());
  EXPECT_EQ(seen, 4);
  EXPECT_EQ(event.state().state(), v1::JOB_STATE_SUCCEEDED);
}

TEST_F(ServerProcessTest, SigtermEndsItCleanlyAlsoWithOpenWatches) {
  const std::string address = process_.start();
  ASSERT_FALSE(address.empty());
  Client client(address);
  v1::SubmitJobResponse submitted;
  grpc::ClientContext submit_context;
  ASSERT_TRUE(
      client.jobs
          ->SubmitJob(&submit_context, job_of(put_artifact(*client.artifacts, "a mesh"), ""), &submitted)
          .ok());
  grpc::ClientContext watch_context;
  set_deadline(watch_context);
  v1::WatchJobRequest watch;
  watch.set_job_id(submitted.job().job_id());
  const auto reader = client.jobs->WatchJob(&watch_context, watch);
  v1::JobEvent event;
  ASSERT_TRUE(reader->Read(&event));
  EXPECT_EQ(process_.stop(SIGTERM), 0);
  EXPECT_FALSE(reader->Read(&event));
  EXPECT_EQ(reader->Finish().error_code(), grpc::StatusCode::UNAVAILABLE);
}

TEST_F(ServerProcessTest, ASecondServerOverTheSameDataIsRefusedInOneSentence) {
  ASSERT_FALSE(process_.start().empty());
  expect_refused("127.0.0.1:0", "data", 1, "another server is using the data folder");
}

TEST_F(ServerProcessTest, ATakenPortIsRefusedInOneSentence) {
  const std::string address = process_.start();
  ASSERT_FALSE(address.empty());
  expect_refused(address, "other", 1, "cannot listen on " + address);
}

TEST_F(ServerProcessTest, TheNetworkWithoutTlsIsRefusedInOneSentence) {
  expect_refused("0.0.0.0:0", "data", 2, "--allow-plaintext");
}

TEST_F(ServerProcessTest, ItsOwnHealthCheckTellsAServingServerFromNone) {
  const std::string address = process_.start();
  ASSERT_FALSE(address.empty());
  EXPECT_EQ(ServerProcess::run({"--check-health", address}, folder_.path()).first, 0);
  EXPECT_EQ(process_.stop(SIGTERM), 0);
  const auto [code, words] = ServerProcess::run({"--check-health", address}, folder_.path());
  EXPECT_EQ(code, 1);
  EXPECT_THAT(words, testing::HasSubstr("does not answer"));
}

TEST_F(ServerProcessTest, ItsOwnHealthCheckNeedsNoFileOfAnEncryptedServer) {
  const std::string at = (folder_.path() / "server").string();
  ASSERT_EQ(std::system(("openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -days 2 "
                         "-subj /CN=elsewhere -keyout " +
                         at + ".key -out " + at + ".crt 2>/dev/null")
                            .c_str()),
            0);
  const std::string address = process_.start({"--tls-cert", at + ".crt", "--tls-key", at + ".key"});
  ASSERT_FALSE(address.empty());
  EXPECT_EQ(ServerProcess::run({"--check-health", address}, folder_.path()).first, 0);
}

}  // namespace
}  // namespace skinframe::server
