// SPDX-License-Identifier: Apache-2.0
// WorkerService: each status that worker.proto documents, and a job's whole life through the API.
#include <functional>
#include <future>

#include "tests/server/api/api_fixture.h"

namespace skinframe::server {
namespace {

class WorkerServiceTest : public ApiTest {
 protected:
  grpc::Status lease_with(const v1::LeaseRequest& request, v1::LeaseResponse* response) {
    grpc::ClientContext context;
    set_deadline(context);
    return workers_->Lease(&context, request, response);
  }
  v1::LeaseRequest long_poll() {
    v1::LeaseRequest request;
    request.set_worker_id("w");
    request.set_instance_id("i");
    request.mutable_wait()->set_seconds(30);
    return request;
  }
};

TEST_F(WorkerServiceTest, AnAssignmentHasAllThatTheWorkNeeds) {
  auto request = v1::SubmitJobRequest();
  *request.mutable_spec() = spec();
  request.mutable_spec()->add_printers()->set_printer_id("makerbot-replicator-2");
  request.mutable_spec()->mutable_printers(1)->set_material_id("pa");
  request.mutable_spec()->mutable_deadline()->set_seconds(60);
  ASSERT_TRUE(submit(request).ok());
  const v1::Assignment assignment = lease();
  EXPECT_EQ(assignment.attempt(), 1);
  EXPECT_GT(assignment.fencing_token(), 0);
  EXPECT_EQ(assignment.spec().SerializeAsString(), request.spec().SerializeAsString());
  ASSERT_EQ(assignment.printers_size(), 2);
  EXPECT_EQ(assignment.printers(1).min_radius_mm(), 0.4);
  ASSERT_EQ(assignment.materials_size(), 2);
  EXPECT_EQ(assignment.materials(0).id(), "pa");  // the printer's default
  EXPECT_EQ(assignment.materials(1).id(), "pa");  // as asked
  EXPECT_EQ(assignment.heartbeat_interval().seconds(), 5);
  EXPECT_EQ(assignment.lease_duration().seconds(), 20);
  EXPECT_EQ(from_timestamp(assignment.lease_expire_time()), clock_.now() + options_.policy.lease);
  EXPECT_EQ(from_timestamp(assignment.deadline()), clock_.now() + std::chrono::seconds(60));
}

TEST_F(WorkerServiceTest, AFramesResultIsKeptAndOnlyAFrameProblemHasOne) {
  submit();
  v1::CompleteRequest wrong = outcome(lease(), v1::JOB_STATE_SUCCEEDED);
  wrong.mutable_frame()->set_mechanics("paper");
  EXPECT_EQ(complete(wrong).error_code(), grpc::StatusCode::INVALID_ARGUMENT);

  v1::SubmitJobRequest problem;
  problem.mutable_spec()->set_frame_problem_sha256(put("{}"));
  ASSERT_TRUE(submit(problem).ok());
  v1::CompleteRequest infeasible = outcome(lease(), v1::JOB_STATE_FAILED, v1::REASON_INFEASIBLE);
  v1::FrameResult& frame = *infeasible.mutable_frame();
  frame.set_mechanics("axial");
  frame.set_best_reachable_displacement_mm(0.07);
  frame.add_stages()->set_stage("size");
  v1::CompleteRequest long_word = infeasible;
  long_word.mutable_frame()->mutable_stages(0)->set_stage(std::string(129, 'x'));
  EXPECT_EQ(complete(long_word).error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  ASSERT_TRUE(complete(infeasible).ok());
  restart();
  const v1::Job kept = job(infeasible.job_id());
  EXPECT_EQ(kept.frame().SerializeAsString(), frame.SerializeAsString());
  EXPECT_EQ(kept.reason(), v1::REASON_INFEASIBLE);
}

TEST_F(WorkerServiceTest, ACheckpointIsHandedToTheNextAttemptUnlessItIsStaleOrNotThere) {
  const std::string id = submit();
  const v1::Assignment first = lease();
  EXPECT_FALSE(first.has_checkpoint());
  v1::CheckpointRequest request;
  request.set_job_id(id);
  request.set_fencing_token(first.fencing_token());
  request.mutable_checkpoint()->set_sha256(put("state"));
  request.mutable_checkpoint()->set_size_bytes(5);
  request.mutable_checkpoint()->set_stage("sample");
  const auto send = [&](const v1::CheckpointRequest& what) {
    grpc::ClientContext context;
    set_deadline(context);
    v1::CheckpointResponse response;
    return workers_->Checkpoint(&context, what, &response).error_code();
  };
  EXPECT_EQ(send(request), grpc::StatusCode::OK);
  const v1::CheckpointRequest good = request;
  request.mutable_checkpoint()->set_sha256(std::string(64, 'b'));
  EXPECT_EQ(send(request), grpc::StatusCode::FAILED_PRECONDITION);
  request.mutable_checkpoint()->set_sha256("no hash");
  EXPECT_EQ(send(request), grpc::StatusCode::INVALID_ARGUMENT);
  request = good;
  request.mutable_checkpoint()->set_size_bytes((std::int64_t{64} << 20) + 1);
  EXPECT_EQ(send(request), grpc::StatusCode::INVALID_ARGUMENT);
  request = good;
  request.set_fencing_token(first.fencing_token() + 1);
  EXPECT_EQ(send(request), grpc::StatusCode::ABORTED);
  request.set_job_id("none");
  EXPECT_EQ(send(request), grpc::StatusCode::ABORTED);

  ASSERT_TRUE(complete(outcome(first, v1::JOB_STATE_CANCELLED)).ok());  // its worker stops
  EXPECT_EQ(send(good), grpc::StatusCode::ABORTED);
  const v1::Assignment second = lease();
  EXPECT_EQ(second.checkpoint().sha256(), good.checkpoint().sha256());
  EXPECT_EQ(second.checkpoint().stage(), "sample");
  EXPECT_EQ(second.checkpoint().attempt(), 1);
  ASSERT_TRUE(complete(outcome(second, v1::JOB_STATE_SUCCEEDED)).ok());
  EXPECT_FALSE(job(id).has_checkpoint());
}

TEST_F(WorkerServiceTest, NothingToDoIsAnEmptyAnswer) {
  v1::LeaseRequest request = long_poll();
  request.clear_wait();
  v1::LeaseResponse response;
  ASSERT_TRUE(lease_with(request, &response).ok());
  EXPECT_FALSE(response.has_assignment());
}

TEST_F(WorkerServiceTest, AWaitingWorkerGetsTheNextJob) {
  auto waiting = std::async(std::launch::async, [&] {
    v1::LeaseResponse response;
    EXPECT_TRUE(lease_with(long_poll(), &response).ok());
    return response.assignment().job_id();
  });
  const std::string id = submit();
  EXPECT_EQ(waiting.get(), id);
}

TEST_F(WorkerServiceTest, WorkersWithoutANameAreInvalidArguments) {
  v1::LeaseResponse response;
  v1::LeaseRequest request;
  request.set_instance_id("i");
  EXPECT_EQ(lease_with(request, &response).error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  request.set_worker_id("w");
  request.clear_instance_id();
  EXPECT_EQ(lease_with(request, &response).error_code(), grpc::StatusCode::INVALID_ARGUMENT);
}

TEST_F(WorkerServiceTest, AWorkerThatHungUpIsPassedOver) {
  grpc::ClientContext gone;
  gone.set_deadline(std::chrono::system_clock::now());
  v1::LeaseResponse response;
  EXPECT_EQ(workers_->Lease(&gone, long_poll(), &response).error_code(), grpc::StatusCode::DEADLINE_EXCEEDED);
  const std::string id = submit();
  ASSERT_TRUE(lease_with(long_poll(), &response).ok());
  EXPECT_EQ(response.assignment().job_id(), id);
}

TEST_F(WorkerServiceTest, HeartbeatsProlongTheLeaseAndBringCancellation) {
  const std::string id = submit();
  const v1::Assignment assignment = lease();
  clock_.advance(Milliseconds(3000));
  v1::HeartbeatResponse response;
  ASSERT_TRUE(beat(assignment, &response, 2).ok());
  EXPECT_FALSE(response.cancel());
  EXPECT_EQ(from_timestamp(response.lease_expire_time()), clock_.now() + options_.policy.lease);
  ASSERT_TRUE(cancel(id).ok());
  EXPECT_EQ(job(id).state(), v1::JOB_STATE_RUNNING);
  EXPECT_TRUE(job(id).cancel_requested());
  ASSERT_TRUE(beat(assignment, &response).ok());
  EXPECT_TRUE(response.cancel());
  ASSERT_TRUE(complete(outcome(assignment, v1::JOB_STATE_CANCELLED, v1::REASON_CANCELLED)).ok());
  EXPECT_EQ(job(id).state(), v1::JOB_STATE_CANCELLED);
}

TEST_F(WorkerServiceTest, ARunningJobPastItsDeadlineIsStoppedAndTimedOut) {
  v1::SubmitJobRequest request;
  *request.mutable_spec() = spec();
  request.mutable_spec()->mutable_deadline()->set_seconds(5);
  ASSERT_TRUE(submit(request).ok());
  const v1::Assignment assignment = lease();
  clock_.advance(Milliseconds(5000));
  v1::HeartbeatResponse response;
  ASSERT_TRUE(beat(assignment, &response).ok());
  EXPECT_TRUE(response.cancel());
  ASSERT_TRUE(complete(outcome(assignment, v1::JOB_STATE_CANCELLED)).ok());
  EXPECT_EQ(job(assignment.job_id()).state(), v1::JOB_STATE_FAILED);
  EXPECT_EQ(job(assignment.job_id()).reason(), v1::REASON_TIMED_OUT);
}

TEST_F(WorkerServiceTest, StaleTokensAndForgottenJobsAreAborted) {
  submit();
  v1::Assignment assignment = lease();
  v1::Assignment stale = assignment;
  stale.set_fencing_token(assignment.fencing_token() + 1);
  EXPECT_EQ(beat(stale).error_code(), grpc::StatusCode::ABORTED);
  EXPECT_EQ(complete(outcome(stale, v1::JOB_STATE_SUCCEEDED)).error_code(), grpc::StatusCode::ABORTED);
  stale.set_job_id("gone");
  EXPECT_EQ(beat(stale).error_code(), grpc::StatusCode::ABORTED);
  EXPECT_EQ(job(assignment.job_id()).state(), v1::JOB_STATE_RUNNING);
}

TEST_F(WorkerServiceTest, ACompletionSentTwiceIsAcceptedTwiceAndCountsOnce) {
  const std::string id = submit();
  auto request = outcome(lease(), v1::JOB_STATE_SUCCEEDED);
  auto& file = *request.add_files();
  file.set_path("report.json");
  file.set_sha256(put("{}"));
  file.set_size_bytes(2);
  ASSERT_TRUE(complete(request).ok());
  const auto last = job(id).last_sequence();
  EXPECT_TRUE(complete(request).ok());
  EXPECT_EQ(job(id).last_sequence(), last);
  EXPECT_EQ(job(id).files(0).path(), "report.json");
}

TEST_F(WorkerServiceTest, FilesThatAreNotUploadedAreAFailedPrecondition) {
  const std::string id = submit();
  auto request = outcome(lease(), v1::JOB_STATE_SUCCEEDED);
  auto& file = *request.add_files();
  file.set_path("report.json");
  file.set_sha256(sha256_hex("{}"));
  file.set_size_bytes(2);
  EXPECT_EQ(complete(request).error_code(), grpc::StatusCode::FAILED_PRECONDITION);
  EXPECT_EQ(job(id).state(), v1::JOB_STATE_RUNNING);
  put("{}");
  EXPECT_TRUE(complete(request).ok());
}

TEST_F(WorkerServiceTest, MalformedCompletionsAreInvalidArguments) {
  submit();
  const v1::Assignment assignment = lease();
  const auto code = [&](const v1::CompleteRequest& request) { return complete(request).error_code(); };
  EXPECT_EQ(code(outcome(assignment, v1::JOB_STATE_RUNNING)), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(code(outcome(assignment, v1::JOB_STATE_FAILED)), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(code(outcome(assignment, v1::JOB_STATE_SUCCEEDED, v1::REASON_CRASHED)),
            grpc::StatusCode::INVALID_ARGUMENT);
  auto retry = outcome(assignment, v1::JOB_STATE_FAILED, v1::REASON_INFEASIBLE);
  retry.set_retryable(true);
  EXPECT_EQ(code(retry), grpc::StatusCode::INVALID_ARGUMENT);
  for (const char* path : {"", "/etc/passwd", "../x", "a/../b", "a//b", "a/", "./a"}) {
    auto request = outcome(assignment, v1::JOB_STATE_SUCCEEDED);
    request.add_files()->set_path(path);
    request.mutable_files(0)->set_sha256(put("{}"));
    EXPECT_EQ(code(request), grpc::StatusCode::INVALID_ARGUMENT) << path;
  }
}

TEST_F(WorkerServiceTest, TooMuchProgressAtOnceIsAnInvalidArgument) {
  submit();
  const v1::Assignment assignment = lease();
  EXPECT_TRUE(beat(assignment, nullptr, 100).ok());
  EXPECT_EQ(beat(assignment, nullptr, 101).error_code(), grpc::StatusCode::INVALID_ARGUMENT);
}

TEST_F(WorkerServiceTest, WordsOfAWorkerAreBounded) {
  submit();
  const v1::Assignment assignment = lease();
  const auto code = [&](const std::function<void(v1::HeartbeatRequest&)>& change) {
    v1::HeartbeatRequest request;
    request.set_job_id(assignment.job_id());
    request.set_fencing_token(assignment.fencing_token());
    change(request);
    v1::HeartbeatResponse response;
    grpc::ClientContext context;
    set_deadline(context);
    return workers_->Heartbeat(&context, request, &response).error_code();
  };
  const auto result = [](v1::HeartbeatRequest& request) -> v1::PrinterResult& {
    auto& printer = *request.add_printers();
    printer.set_printer_id("sinterstation-hiq");
    return printer;
  };
  const std::string longest(128, 'x'), longer(129, 'x');
  EXPECT_EQ(code([&](auto& r) { r.add_progress()->set_stage(longest); }), grpc::StatusCode::OK);
  EXPECT_EQ(code([&](auto& r) { r.add_progress()->set_stage(longer); }), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(code([&](auto& r) { result(r).set_material_id(longest); }), grpc::StatusCode::OK);
  EXPECT_EQ(code([&](auto& r) { result(r).set_material_id(longer); }), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(code([&](auto& r) { result(r).mutable_statistics()->set_balance(longest); }),
            grpc::StatusCode::OK);
  EXPECT_EQ(code([&](auto& r) { result(r).mutable_statistics()->set_balance(longer); }),
            grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(code([&](auto& r) { r.add_progress()->set_printer_id("sinterstation-hiq"); }),
            grpc::StatusCode::OK);
  EXPECT_EQ(code([&](auto& r) { r.add_progress()->set_printer_id("teapot"); }),
            grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(code([&](auto& r) { r.add_printers()->set_printer_id("teapot"); }),
            grpc::StatusCode::INVALID_ARGUMENT);
  auto done = outcome(assignment, v1::JOB_STATE_SUCCEEDED);
  done.add_printers()->set_printer_id("teapot");
  EXPECT_EQ(complete(done).error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_EQ(job(assignment.job_id()).state(), v1::JOB_STATE_RUNNING);
}

TEST_F(WorkerServiceTest, ARetryableFailureIsTriedAgainAfterTheBackoff) {
  const std::string id = submit();
  const v1::Assignment first = lease();
  auto crash = outcome(first, v1::JOB_STATE_FAILED, v1::REASON_CRASHED);
  crash.set_retryable(true);
  ASSERT_TRUE(complete(crash).ok());
  EXPECT_EQ(job(id).state(), v1::JOB_STATE_QUEUED);
  clock_.advance(options_.policy.first_backoff);
  const v1::Assignment second = lease();
  EXPECT_EQ(second.attempt(), 2);
  EXPECT_GT(second.fencing_token(), first.fencing_token());
}

TEST_F(WorkerServiceTest, ARestartOfTheServerCostsTheWorkerNothing) {
  const std::string id = submit();
  const v1::Assignment assignment = lease();
  restart();
  v1::HeartbeatResponse response;
  EXPECT_TRUE(beat(assignment, &response, 1).ok());
  EXPECT_TRUE(complete(outcome(assignment, v1::JOB_STATE_SUCCEEDED)).ok());
  EXPECT_EQ(job(id).state(), v1::JOB_STATE_SUCCEEDED);
  EXPECT_EQ(job(id).attempt(), 1);
}

}  // namespace
}  // namespace skinframe::server
