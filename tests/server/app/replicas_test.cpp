// SPDX-License-Identifier: Apache-2.0
// Two real servers on one PostgreSQL and one artifact folder: what one is told, the other knows.
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <string>
#include <thread>
#include <vector>

#include "skinframe/v1/artifact.grpc.pb.h"
#include "skinframe/v1/job.grpc.pb.h"
#include "skinframe/v1/worker.grpc.pb.h"
#include "tests/server/app/put_artifact.h"
#include "tests/server/app/server_process.h"
#include "tests/server/fixture/postgres_server.h"
#include "tests/server/fixture/temporary_folder.h"

namespace skinframe::server {
namespace {

struct Replica {
  Replica(const std::filesystem::path& folder, const std::string& database,
          const std::filesystem::path& shared)
      : process(folder), arguments({"--store", database, "--artifacts", shared.string()}) {
    std::filesystem::create_directories(folder);
    start();
  }
  void start() {
    const std::string address = process.start(arguments);
    EXPECT_FALSE(address.empty());
    const auto channel = grpc::CreateChannel(address, grpc::InsecureChannelCredentials());
    jobs = v1::JobService::NewStub(channel);
    artifacts = v1::ArtifactService::NewStub(channel);
    workers = v1::WorkerService::NewStub(channel);
  }

  std::string put(const std::string& content) { return put_artifact(*artifacts, content); }
  std::string submit(const std::string& mesh) {
    grpc::ClientContext context;
    set_deadline(context);
    v1::SubmitJobRequest request;
    request.mutable_spec()->set_mesh_sha256(mesh);
    request.mutable_spec()->add_printers()->set_printer_id("sinterstation-hiq");
    v1::SubmitJobResponse response;
    const grpc::Status status = jobs->SubmitJob(&context, request, &response);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return response.job().job_id();
  }
  v1::Assignment lease() {
    grpc::ClientContext context;
    set_deadline(context);
    v1::LeaseRequest request;
    request.set_worker_id("worker");
    request.set_instance_id("instance");
    request.mutable_wait()->set_seconds(20);
    v1::LeaseResponse response;
    const grpc::Status status = workers->Lease(&context, request, &response);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return response.assignment();
  }
  grpc::Status beat(const v1::Assignment& job, int iteration) {
    grpc::ClientContext context;
    set_deadline(context);
    v1::HeartbeatRequest request;
    request.set_job_id(job.job_id());
    request.set_fencing_token(job.fencing_token());
    request.add_progress()->set_iteration(iteration);
    v1::HeartbeatResponse response;
    return workers->Heartbeat(&context, request, &response);
  }
  grpc::Status complete(const v1::Assignment& job) {
    grpc::ClientContext context;
    set_deadline(context);
    v1::CompleteRequest request;
    request.set_job_id(job.job_id());
    request.set_fencing_token(job.fencing_token());
    request.set_state(v1::JOB_STATE_FAILED);
    request.set_reason(v1::REASON_INVALID_INPUT);
    request.set_detail("a mesh of two words");
    v1::CompleteResponse response;
    return workers->Complete(&context, request, &response);
  }

  ServerProcess process;
  const std::vector<std::string> arguments;
  std::unique_ptr<v1::JobService::Stub> jobs;
  std::unique_ptr<v1::ArtifactService::Stub> artifacts;
  std::unique_ptr<v1::WorkerService::Stub> workers;
};

class Replicas : public testing::Test {
 protected:
  TemporaryFolder folder_;
  PostgresServer database_;
  const std::string where_ = database_.new_database();
  Replica one_{folder_.path() / "one", where_, folder_.path() / "artifacts"};
  Replica other_{folder_.path() / "other", where_, folder_.path() / "artifacts"};
};

TEST_F(Replicas, AWatchOnOneSeesEveryEventWrittenThroughTheOtherInOrder) {
  const std::string job_id = one_.submit(one_.put("a mesh"));
  grpc::ClientContext context;
  set_deadline(context);
  v1::WatchJobRequest request;
  request.set_job_id(job_id);
  const auto watch = one_.jobs->WatchJob(&context, request);
  v1::JobEvent event;
  const auto next = [&] {
    EXPECT_TRUE(watch->Read(&event)) << "the watch ended before event " << event.sequence() + 1;
    return event.sequence();
  };
  EXPECT_EQ(next(), 1);
  const v1::Assignment job = other_.lease();
  EXPECT_EQ(job.job_id(), job_id);
  EXPECT_EQ(next(), 2);
  EXPECT_EQ(event.state().state(), v1::JOB_STATE_RUNNING);
  ASSERT_TRUE(other_.beat(job, 7).ok());
  EXPECT_EQ(next(), 3);
  EXPECT_EQ(event.progress().iteration(), 7);
  ASSERT_TRUE(one_.beat(job, 8).ok());  // a worker may talk to any
  EXPECT_EQ(next(), 4);
  ASSERT_TRUE(other_.complete(job).ok());
  EXPECT_EQ(next(), 5);
  EXPECT_EQ(event.state().state(), v1::JOB_STATE_FAILED);
  EXPECT_FALSE(watch->Read(&event));
  EXPECT_TRUE(watch->Finish().ok());
}

TEST_F(Replicas, AWorkerThatWaitsAtOneGetsTheJobSubmittedToTheOther) {
  v1::Assignment job;
  std::thread worker([&] { job = other_.lease(); });
  const std::string job_id = one_.submit(one_.put("a mesh"));
  worker.join();
  EXPECT_EQ(job.job_id(), job_id);
}

TEST_F(Replicas, WhatAKilledServerAcknowledgedIsFinishedThroughTheOther) {
  const std::string mesh = one_.put("a mesh");
  std::vector<std::string> ids;
  for (int i = 0; i < 10; ++i) ids.push_back(one_.submit(mesh));
  const v1::Assignment first = one_.lease();
  one_.process.stop(SIGKILL);
  ASSERT_TRUE(other_.beat(first, 1).ok());
  ASSERT_TRUE(other_.complete(first).ok());
  for (int i = 1; i < 10; ++i) {
    const v1::Assignment job = other_.lease();
    EXPECT_EQ(job.job_id(), ids[static_cast<std::size_t>(i)]);  // in order of submission
    ASSERT_TRUE(other_.complete(job).ok());
  }
  one_.start();
  for (const std::string& id : ids) {
    grpc::ClientContext context;
    set_deadline(context);
    v1::GetJobRequest request;
    request.set_job_id(id);
    v1::Job job;
    ASSERT_TRUE(one_.jobs->GetJob(&context, request, &job).ok());
    EXPECT_EQ(job.state(), v1::JOB_STATE_FAILED);
  }
}

TEST_F(Replicas, ARestartedDatabaseIsFoundAgainByBoth) {
  const std::string mesh = one_.put("a mesh");
  const std::string before = one_.submit(mesh);
  database_.restart();
  EXPECT_EQ(other_.lease().job_id(), before);
  const std::string after = other_.submit(mesh);
  EXPECT_EQ(one_.lease().job_id(), after);
}

}  // namespace
}  // namespace skinframe::server
