// SPDX-License-Identifier: Apache-2.0
// Tenants do not see each other, take no more than their quotas, and workers serve them all.
#include <chrono>
#include <fstream>
#include <thread>

#include "tests/server/api/api_fixture.h"

namespace skinframe::server {
namespace {

class Tenants : public ApiTest {
 protected:
  void SetUp() override {
    write_tenants("");
    start();
  }

  // Three tenants by token, named like it; rule stands in north's entry.
  void write_tenants(const std::string& rule) {
    options_.tenants = folder_.path() / "tenants.json";
    std::ofstream out(options_.tenants);
    out << R"({"workers": {"token_sha256": [")" << sha256_hex("worker") << R"("]}, "tenants": [)";
    for (const std::string name : {"north", "south"}) {
      out << R"({"name": ")" << name << R"(", "token_sha256": [")" << sha256_hex(name) << "\"]";
      if (name == "north" && !rule.empty()) out << ", " << rule;
      out << (name == "north" ? "}, " : "}");
    }
    out << "]}";
  }
  void restart_with(const std::string& rule) {
    server_.reset();
    write_tenants(rule);
    start();
  }

  grpc::StatusCode get(const std::string& job_id) {
    grpc::ClientContext context;
    prepare(context);
    v1::GetJobRequest request;
    request.set_job_id(job_id);
    v1::Job job;
    return jobs_->GetJob(&context, request, &job).error_code();
  }
  v1::StatArtifactResponse stat(const std::string& sha256) {
    grpc::ClientContext context;
    prepare(context);
    v1::StatArtifactRequest request;
    request.set_sha256(sha256);
    v1::StatArtifactResponse response;
    EXPECT_TRUE(artifacts_->Stat(&context, request, &response).ok());
    return response;
  }
  grpc::Status download(const std::string& sha256, const v1::Assignment* of = nullptr) {
    grpc::ClientContext context;
    prepare(context);
    if (of != nullptr) {
      context.AddMetadata("skinframe-job-id", of->job_id());
      context.AddMetadata("skinframe-fencing-token", std::to_string(of->fencing_token()));
    }
    v1::DownloadArtifactRequest request;
    request.set_sha256(sha256);
    const auto reader = artifacts_->Download(&context, request);
    v1::DownloadArtifactResponse chunk;
    while (reader->Read(&chunk)) {
    }
    return reader->Finish();
  }
};

TEST_F(Tenants, NoneSeesAnothersJobs) {
  token_ = "north";
  const std::string id = submit();
  EXPECT_EQ(job(id).tenant(), "north");
  token_ = "south";
  EXPECT_EQ(get(id), grpc::StatusCode::NOT_FOUND);
  EXPECT_EQ(cancel(id).error_code(), grpc::StatusCode::NOT_FOUND);
  std::vector<v1::JobEvent> events;
  EXPECT_EQ(watch(id, 0, &events).error_code(), grpc::StatusCode::NOT_FOUND);
  EXPECT_TRUE(events.empty());
  v1::SubmitJobRequest warm;
  *warm.mutable_spec() = spec();
  warm.mutable_spec()->set_warm_start_job_id(id);
  EXPECT_EQ(submit(warm).error_code(), grpc::StatusCode::NOT_FOUND);
  grpc::ClientContext forget_context;
  prepare(forget_context);
  v1::DeleteJobRequest forget;
  forget.set_job_id(id);
  v1::DeleteJobResponse forgotten;
  EXPECT_EQ(jobs_->DeleteJob(&forget_context, forget, &forgotten).error_code(), grpc::StatusCode::NOT_FOUND);
  grpc::ClientContext list_context;
  prepare(list_context);
  v1::ListJobsResponse jobs;
  ASSERT_TRUE(jobs_->ListJobs(&list_context, {}, &jobs).ok());
  EXPECT_EQ(jobs.jobs_size(), 0);
}

TEST_F(Tenants, NoneSeesAnothersArtifactsNorThePartOfAnUpload) {
  token_ = "north";
  const std::string mesh = put("a mesh");
  upload(header("half of a mesh"), {"half"});
  EXPECT_TRUE(stat(mesh).complete());
  EXPECT_EQ(stat(sha256_hex("half of a mesh")).resume_offset(), 4);
  token_ = "south";
  EXPECT_FALSE(stat(mesh).complete());
  EXPECT_EQ(stat(sha256_hex("half of a mesh")).resume_offset(), 0);
  EXPECT_EQ(download(mesh).error_code(), grpc::StatusCode::NOT_FOUND);
  v1::SubmitJobRequest request;
  request.mutable_spec()->set_mesh_sha256(mesh);
  request.mutable_spec()->add_printers()->set_printer_id("sinterstation-hiq");
  EXPECT_EQ(submit(request).error_code(), grpc::StatusCode::FAILED_PRECONDITION);
  EXPECT_EQ(put("a mesh"), mesh) << "who has the content may say so";
}

TEST_F(Tenants, WhoIsNotKnownIsRefusedAndOnlyWorkersWork) {
  EXPECT_EQ(get("any"), grpc::StatusCode::UNAUTHENTICATED);
  token_ = "nobody's";
  EXPECT_EQ(get("any"), grpc::StatusCode::UNAUTHENTICATED);
  token_ = "north";
  grpc::ClientContext context;
  prepare(context);
  v1::LeaseRequest request;
  request.set_worker_id("w");
  request.set_instance_id("i");
  v1::LeaseResponse response;
  EXPECT_EQ(workers_->Lease(&context, request, &response).error_code(), grpc::StatusCode::PERMISSION_DENIED);
  const std::string id = submit();
  token_ = "worker";
  const v1::Assignment work = lease();
  EXPECT_EQ(work.job_id(), id);
  token_ = "south";
  EXPECT_EQ(beat(work).error_code(), grpc::StatusCode::PERMISSION_DENIED);
  grpc::ClientContext checkpoint_context;
  prepare(checkpoint_context);
  v1::CheckpointRequest checkpoint;
  checkpoint.set_job_id(id);
  checkpoint.set_fencing_token(work.fencing_token());
  v1::CheckpointResponse accepted;
  EXPECT_EQ(workers_->Checkpoint(&checkpoint_context, checkpoint, &accepted).error_code(),
            grpc::StatusCode::PERMISSION_DENIED);
  EXPECT_EQ(complete(outcome(work, v1::JOB_STATE_SUCCEEDED)).error_code(),
            grpc::StatusCode::PERMISSION_DENIED);
  EXPECT_EQ(download(sha256_hex("a mesh"), &work).error_code(), grpc::StatusCode::PERMISSION_DENIED);
}

TEST_F(Tenants, AWorkerHasTheFilesOfTheJobItRunsAndOnlyWhileItRunsIt) {
  token_ = "north";
  submit();
  token_ = "worker";
  const v1::Assignment work = lease();
  const std::string mesh = sha256_hex("a mesh");
  EXPECT_TRUE(download(mesh, &work).ok());
  v1::Assignment stale = work;
  stale.set_fencing_token(work.fencing_token() + 1);
  EXPECT_EQ(download(mesh, &stale).error_code(), grpc::StatusCode::ABORTED);
  ASSERT_TRUE(complete(outcome(work, v1::JOB_STATE_FAILED, v1::REASON_INFEASIBLE)).ok());
  EXPECT_EQ(download(mesh, &work).error_code(), grpc::StatusCode::ABORTED);
}

TEST_F(Tenants, QuotasAreNamedWithTheirRemedyAndQueuedOnesCanBeRetried) {
  restart_with(R"("most_queued": 1, "most_artifact_bytes": 10)");
  token_ = "north";
  submit();
  v1::SubmitJobRequest second;
  *second.mutable_spec() = spec();
  const grpc::Status queued = submit(second);
  EXPECT_EQ(queued.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_NE(queued.error_message().find("quota of queued jobs"), std::string::npos) << queued.error_message();
  EXPECT_GT(retry_delay(queued).value_or(Milliseconds(0)), Milliseconds(0));
  const grpc::Status bytes = upload(header("12345678"), {"12345678"});  // "a mesh" has 6
  EXPECT_EQ(bytes.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_NE(bytes.error_message().find("quota of artifact bytes"), std::string::npos)
      << bytes.error_message();
  EXPECT_FALSE(retry_delay(bytes)) << "waiting does not help";
  EXPECT_NE(bytes.error_message().find("delete jobs"), std::string::npos) << bytes.error_message();
  EXPECT_TRUE(upload(header("1234"), {"1234"}).ok());
  token_ = "south";
  submit();
  EXPECT_TRUE(upload(header("12345678"), {"12345678"}).ok());
}

TEST_F(Tenants, TheFileIsReadAgainAndABadOneKeepsWhoWasWhose) {
  token_ = "north";
  const std::string first = submit();
  v1::SubmitJobRequest second;
  *second.mutable_spec() = spec();
  second.set_no_reuse(true);
  write_tenants(R"("most_queued": 1)");
  server_->reload();
  while (submit(second).ok()) std::this_thread::yield();  // the duty has its round every 100 ms
  EXPECT_EQ(submit(second).error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  write_tenants(R"("most_queued": "many")");
  server_->reload();
  const auto asked = std::chrono::steady_clock::now();
  while (std::chrono::steady_clock::now() - asked < std::chrono::milliseconds(300)) {
    EXPECT_EQ(submit(second).error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
    EXPECT_EQ(get(first), grpc::StatusCode::OK);
  }
  write_tenants("");
  server_->reload();
  while (!submit(second).ok()) std::this_thread::yield();
}

TEST_F(Tenants, WorkersTakeTurnsAndTheQuotaOfRunningJobsHoldsTheRestBack) {
  restart_with(R"("most_running": 2)");
  token_ = "north";
  for (int i = 0; i < 4; ++i) submit();
  token_ = "south";
  for (int i = 0; i < 4; ++i) submit();
  token_ = "worker";
  std::string served;
  v1::Assignment of_north;
  for (int i = 0; i < 6; ++i) {
    const v1::Assignment work = lease();
    token_ = "north";
    const bool north = get(work.job_id()) == grpc::StatusCode::OK;
    token_ = "worker";
    if (north) of_north = work;
    served += north ? 'n' : 's';
  }
  EXPECT_EQ(served, "nsnsss");
  ASSERT_TRUE(complete(outcome(of_north, v1::JOB_STATE_FAILED, v1::REASON_INFEASIBLE)).ok());
  const std::string next = lease().job_id();
  token_ = "north";
  EXPECT_EQ(get(next), grpc::StatusCode::OK);
}

TEST_F(Tenants, AFileThatIsWrongIsToldInOneSentence) {
  server_.reset();
  std::ofstream(options_.tenants) << R"({"workers": {}, "tenants": [{"name": "North Farm"}]})";
  const auto server = Server::start(options_, clock_, ids_);
  ASSERT_FALSE(server.ok());
  EXPECT_NE(server.status().message().find("tenants[0].name"), absl::string_view::npos) << server.status();
}

}  // namespace
}  // namespace skinframe::server
