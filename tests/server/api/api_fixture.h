// SPDX-License-Identifier: Apache-2.0
// A whole server in this process, spoken to over loopback. Its clock stands still until the test turns it.
#pragma once

#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/app/server.h"
#include "skinframe/v1/artifact.grpc.pb.h"
#include "skinframe/v1/catalog.grpc.pb.h"
#include "skinframe/v1/job.grpc.pb.h"
#include "skinframe/v1/worker.grpc.pb.h"
#include "tests/server/fixture/manual_clock.h"
#include "tests/server/fixture/temporary_folder.h"

namespace skinframe::server {

class ApiTest : public testing::Test {
 protected:
  void SetUp() override { start(); }

  void start();
  void restart();

  void prepare(grpc::ClientContext& context) const;  // deadline and token

  // Uploads the content in one chunk; returns its name.
  std::string put(const std::string& content);
  v1::StatArtifactResponse stat(const std::string& sha256, grpc::StatusCode expected = grpc::StatusCode::OK);
  grpc::Status upload(const v1::UploadArtifactRequest::Header& header,
                      const std::vector<std::string>& chunks);
  v1::UploadArtifactRequest::Header header(const std::string& content, std::int64_t offset = 0);

  v1::JobSpec spec();  // valid, its mesh uploaded
  grpc::Status submit(const v1::SubmitJobRequest& request, v1::SubmitJobResponse* response = nullptr);
  std::string submit();  // spec(), to be run whatever was before; the job's id
  v1::Job job(const std::string& job_id);
  grpc::Status cancel(const std::string& job_id);

  v1::Assignment lease();  // the next job; fails the test when there is none
  grpc::Status beat(const v1::Assignment& assignment, v1::HeartbeatResponse* response = nullptr,
                    int progress = 0);
  v1::CompleteRequest outcome(const v1::Assignment& assignment, v1::JobState state,
                              v1::Reason reason = v1::REASON_UNSPECIFIED);
  grpc::Status complete(const v1::CompleteRequest& request);

  // All events until the stream ends.
  grpc::Status watch(const std::string& job_id, std::int64_t after, std::vector<v1::JobEvent>* events);

  std::string token_;  // who the next calls come from; empty: from nobody known
  ManualClock clock_;
  RandomIds ids_;
  TemporaryFolder folder_;
  ServerOptions options_;
  std::unique_ptr<Server> server_;
  std::unique_ptr<v1::JobService::Stub> jobs_;
  std::unique_ptr<v1::ArtifactService::Stub> artifacts_;
  std::unique_ptr<v1::CatalogService::Stub> catalog_;
  std::unique_ptr<v1::WorkerService::Stub> workers_;
};

// What the status asks its caller to wait (RetryInfo); nothing: no word of it.
std::optional<Milliseconds> retry_delay(const grpc::Status& status);

// A test that hangs is a failure, not a time-out of the suite.
void set_deadline(grpc::ClientContext& context);

}  // namespace skinframe::server
