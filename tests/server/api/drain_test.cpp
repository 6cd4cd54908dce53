// SPDX-License-Identifier: Apache-2.0
// A server that stops: what is under way is finished, the rest is told to go elsewhere or to come back.
#include <future>
#include <thread>

#include "tests/server/api/api_fixture.h"

namespace skinframe::server {
namespace {

using Drain = ApiTest;

TEST_F(Drain, AnUploadUnderWayIsFinishedAndKeptWhileNothingNewIsTaken) {
  const std::string content = "a mesh in two parts";
  grpc::ClientContext context;
  set_deadline(context);
  v1::UploadArtifactResponse response;
  const auto writer = artifacts_->Upload(&context, &response);
  v1::UploadArtifactRequest message;
  *message.mutable_header() = header(content);
  ASSERT_TRUE(writer->Write(message));
  message.set_chunk(content.substr(0, 5));
  ASSERT_TRUE(writer->Write(message));
  while (stat(sha256_hex(content)).resume_offset() < 5) std::this_thread::yield();  // the call is under way

  v1::SubmitJobRequest request;
  *request.mutable_spec() = spec();
  auto stopped = std::async(std::launch::async, [&] { server_->stop(); });
  while (submit(request).error_code() != grpc::StatusCode::UNAVAILABLE) std::this_thread::yield();
  message.set_chunk(content.substr(5));
  EXPECT_TRUE(writer->Write(message));
  writer->WritesDone();
  const grpc::Status finished = writer->Finish();
  EXPECT_TRUE(finished.ok()) << finished.error_message();
  stopped.get();
  restart();
  EXPECT_EQ(upload(header(content), {}).error_code(), grpc::StatusCode::OK) << "it is there already";
}

TEST_F(Drain, ThinnedProgressEndsAWatchWithTheNumberWhereItGoesOn) {
  const std::string id = submit();
  const v1::Assignment work = lease();
  ASSERT_TRUE(beat(work, nullptr, 3).ok());  // events 3, 4, 5
  ASSERT_TRUE(complete(outcome(work, v1::JOB_STATE_FAILED, v1::REASON_INFEASIBLE)).ok());
  clock_.advance(Milliseconds((options_.keep_progress_hours + 1) * 3'600'000LL));
  std::vector<v1::JobEvent> events;
  grpc::Status status;
  do {  // the duty has its round every 100 ms
    events.clear();
    status = watch(id, 0, &events);
  } while (status.ok());
  EXPECT_EQ(status.error_code(), grpc::StatusCode::OUT_OF_RANGE);
  EXPECT_EQ(events.size(), 2u);
  grpc::ClientContext context;
  set_deadline(context);
  v1::WatchJobRequest request;
  request.set_job_id(id);
  request.set_after_sequence(2);
  const auto reader = jobs_->WatchJob(&context, request);
  v1::JobEvent event;
  EXPECT_FALSE(reader->Read(&event));
  EXPECT_EQ(reader->Finish().error_code(), grpc::StatusCode::OUT_OF_RANGE);
  const auto next = context.GetServerTrailingMetadata().find("first-available-sequence");
  ASSERT_NE(next, context.GetServerTrailingMetadata().end());
  EXPECT_EQ(std::string(next->second.data(), next->second.size()), "6");
  events.clear();
  EXPECT_TRUE(watch(id, 5, &events).ok());
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].state().state(), v1::JOB_STATE_FAILED);
}

}  // namespace
}  // namespace skinframe::server
