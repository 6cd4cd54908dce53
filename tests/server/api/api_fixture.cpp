// SPDX-License-Identifier: Apache-2.0
#include "tests/server/api/api_fixture.h"

#include <chrono>

#include "skinframe/v1/status.pb.h"

namespace skinframe::server {

void set_deadline(grpc::ClientContext& context) {
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(30));
}

std::optional<Milliseconds> retry_delay(const grpc::Status& status) {
  v1::StatusDetails details;
  if (!details.ParseFromString(status.error_details()) || details.details_size() == 0) return std::nullopt;
  EXPECT_EQ(details.code(), status.error_code());
  EXPECT_EQ(details.message(), status.error_message());
  EXPECT_EQ(details.details(0).type_url(), "type.googleapis.com/google.rpc.RetryInfo");
  v1::RetryInfo retry;
  EXPECT_TRUE(retry.ParseFromString(details.details(0).value()));
  return from_duration(retry.retry_delay());
}

void ApiTest::prepare(grpc::ClientContext& context) const {
  set_deadline(context);
  if (!token_.empty()) context.AddMetadata("authorization", "Bearer " + token_);
}

void ApiTest::start() {
  options_.listen = "127.0.0.1:0";
  options_.data = folder_.path();
  auto server = Server::start(options_, clock_, ids_);
  ASSERT_TRUE(server.ok()) << server.status();
  server_ = *std::move(server);
  const auto channel = grpc::CreateChannel(server_->address(), grpc::InsecureChannelCredentials());
  jobs_ = v1::JobService::NewStub(channel);
  artifacts_ = v1::ArtifactService::NewStub(channel);
  catalog_ = v1::CatalogService::NewStub(channel);
  workers_ = v1::WorkerService::NewStub(channel);
}

void ApiTest::restart() {
  server_.reset();
  start();
}

v1::UploadArtifactRequest::Header ApiTest::header(const std::string& content, std::int64_t offset) {
  v1::UploadArtifactRequest::Header header;
  header.set_sha256(sha256_hex(content));
  header.set_size_bytes(static_cast<std::int64_t>(content.size()));
  header.set_offset(offset);
  return header;
}

v1::StatArtifactResponse ApiTest::stat(const std::string& sha256, grpc::StatusCode expected) {
  grpc::ClientContext context;
  prepare(context);
  v1::StatArtifactRequest request;
  request.set_sha256(sha256);
  v1::StatArtifactResponse response;
  EXPECT_EQ(artifacts_->Stat(&context, request, &response).error_code(), expected);
  return response;
}

grpc::Status ApiTest::upload(const v1::UploadArtifactRequest::Header& header,
                             const std::vector<std::string>& chunks) {
  grpc::ClientContext context;
  prepare(context);
  v1::UploadArtifactResponse response;
  const auto writer = artifacts_->Upload(&context, &response);
  v1::UploadArtifactRequest message;
  *message.mutable_header() = header;
  bool open = writer->Write(message);
  for (const std::string& chunk : chunks) {
    message.set_chunk(chunk);
    open = open && writer->Write(message);
  }
  if (open) writer->WritesDone();
  return writer->Finish();
}

std::string ApiTest::put(const std::string& content) {
  const grpc::Status status = upload(header(content), {content});
  EXPECT_TRUE(status.ok()) << status.error_message();
  return sha256_hex(content);
}

v1::JobSpec ApiTest::spec() {
  v1::JobSpec spec;
  spec.set_mesh_sha256(put("a mesh"));
  spec.set_mesh_name("mesh.obj");
  spec.add_printers()->set_printer_id("sinterstation-hiq");
  return spec;
}

grpc::Status ApiTest::submit(const v1::SubmitJobRequest& request, v1::SubmitJobResponse* response) {
  grpc::ClientContext context;
  prepare(context);
  v1::SubmitJobResponse ignored;
  return jobs_->SubmitJob(&context, request, response != nullptr ? response : &ignored);
}

std::string ApiTest::submit() {
  v1::SubmitJobRequest request;
  *request.mutable_spec() = spec();
  request.set_no_reuse(true);
  v1::SubmitJobResponse response;
  const grpc::Status status = submit(request, &response);
  EXPECT_TRUE(status.ok()) << status.error_message();
  return response.job().job_id();
}

v1::Job ApiTest::job(const std::string& job_id) {
  grpc::ClientContext context;
  prepare(context);
  v1::GetJobRequest request;
  request.set_job_id(job_id);
  v1::Job job;
  const grpc::Status status = jobs_->GetJob(&context, request, &job);
  EXPECT_TRUE(status.ok()) << status.error_message();
  return job;
}

grpc::Status ApiTest::cancel(const std::string& job_id) {
  grpc::ClientContext context;
  prepare(context);
  v1::CancelJobRequest request;
  request.set_job_id(job_id);
  v1::Job job;
  return jobs_->CancelJob(&context, request, &job);
}

v1::Assignment ApiTest::lease() {
  grpc::ClientContext context;
  prepare(context);
  v1::LeaseRequest request;
  request.set_worker_id("worker");
  request.set_instance_id("instance");
  v1::LeaseResponse response;
  const grpc::Status status = workers_->Lease(&context, request, &response);
  EXPECT_TRUE(status.ok()) << status.error_message();
  EXPECT_TRUE(response.has_assignment());
  return response.assignment();
}

grpc::Status ApiTest::beat(const v1::Assignment& assignment, v1::HeartbeatResponse* response, int progress) {
  grpc::ClientContext context;
  prepare(context);
  v1::HeartbeatRequest request;
  request.set_job_id(assignment.job_id());
  request.set_fencing_token(assignment.fencing_token());
  for (int i = 0; i < progress; ++i) {
    request.add_progress()->set_stage("size");
    request.mutable_progress(i)->set_iteration(i);
  }
  v1::HeartbeatResponse ignored;
  return workers_->Heartbeat(&context, request, response != nullptr ? response : &ignored);
}

v1::CompleteRequest ApiTest::outcome(const v1::Assignment& assignment, v1::JobState state,
                                     v1::Reason reason) {
  v1::CompleteRequest request;
  request.set_job_id(assignment.job_id());
  request.set_fencing_token(assignment.fencing_token());
  request.set_state(state);
  request.set_reason(reason);
  return request;
}

grpc::Status ApiTest::complete(const v1::CompleteRequest& request) {
  grpc::ClientContext context;
  prepare(context);
  v1::CompleteResponse response;
  return workers_->Complete(&context, request, &response);
}

grpc::Status ApiTest::watch(const std::string& job_id, std::int64_t after,
                            std::vector<v1::JobEvent>* events) {
  grpc::ClientContext context;
  prepare(context);
  v1::WatchJobRequest request;
  request.set_job_id(job_id);
  request.set_after_sequence(after);
  const auto reader = jobs_->WatchJob(&context, request);
  v1::JobEvent event;
  while (reader->Read(&event)) events->push_back(event);
  return reader->Finish();
}

}  // namespace skinframe::server
