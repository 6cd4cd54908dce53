// SPDX-License-Identifier: Apache-2.0
// SubmitJob: each status that job.proto documents.
#include "tests/server/api/api_fixture.h"

namespace skinframe::server {
namespace {

class SubmitTest : public ApiTest {
 protected:
  v1::SubmitJobRequest request(const std::string& request_id = "") {
    v1::SubmitJobRequest request;
    request.set_request_id(request_id);
    *request.mutable_spec() = spec();
    return request;
  }
};

TEST_F(SubmitTest, ReturnsTheQueuedJobAndItsPlace) {
  submit();
  v1::SubmitJobResponse response;
  ASSERT_TRUE(submit(request(), &response).ok());
  EXPECT_EQ(response.job().state(), v1::JOB_STATE_QUEUED);
  EXPECT_EQ(response.job().job_id().size(), 32u);
  EXPECT_EQ(response.job().last_sequence(), 1);
  EXPECT_EQ(response.queued_before(), 1);
}

TEST_F(SubmitTest, TheSameRequestIsTheSameJobAlsoAfterARestart) {
  v1::SubmitJobResponse first;
  v1::SubmitJobResponse second;
  ASSERT_TRUE(submit(request("r"), &first).ok());
  restart();
  ASSERT_TRUE(submit(request("r"), &second).ok());
  EXPECT_EQ(first.job().job_id(), second.job().job_id());
}

TEST_F(SubmitTest, TheSameRequestIdWithAnotherSpecAlreadyExists) {
  ASSERT_TRUE(submit(request("r")).ok());
  auto other = request("r");
  other.mutable_spec()->set_priority(1);
  EXPECT_EQ(submit(other).error_code(), grpc::StatusCode::ALREADY_EXISTS);
}

TEST_F(SubmitTest, AMessageThatQuotesALongNameIsCutBetweenTwoCharacters) {
  auto printer = request();
  std::string name = "x";
  while (name.size() < 10'000) name += "\u00e4";  // two bytes, at odd positions
  printer.mutable_spec()->mutable_printers(0)->set_printer_id(name);
  const std::string message = submit(printer).error_message();
  const std::string begin = "unknown printer \"";
  const std::size_t cut = begin.size() + 1 + (1021 - begin.size() - 1) / 2 * 2;
  EXPECT_EQ(message, (begin + name).substr(0, cut) + "...");
}

TEST_F(SubmitTest, WrongSpecsAndRequestIdsAreInvalidArguments) {
  auto printer = request();
  printer.mutable_spec()->mutable_printers(0)->set_printer_id("x");
  const grpc::Status status = submit(printer);
  EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  EXPECT_TRUE(status.error_message().starts_with("unknown printer \"x\"; known: bambu-x1-carbon, "))
      << status.error_message();
  EXPECT_EQ(submit(request("not an id")).error_code(), grpc::StatusCode::INVALID_ARGUMENT);
}

TEST_F(SubmitTest, AMeshThatIsNotUploadedIsAFailedPrecondition) {
  auto absent = request();
  absent.mutable_spec()->set_mesh_sha256(std::string(64, '0'));
  EXPECT_EQ(submit(absent).error_code(), grpc::StatusCode::FAILED_PRECONDITION);
}

TEST_F(SubmitTest, AFrameProblemIsAJobOfItsOwn) {
  v1::SubmitJobRequest problem;
  problem.mutable_spec()->set_frame_problem_sha256(std::string(64, '0'));
  const grpc::Status absent = submit(problem);
  EXPECT_EQ(absent.error_code(), grpc::StatusCode::FAILED_PRECONDITION);
  EXPECT_NE(absent.error_message().find("frame problem"), std::string::npos) << absent.error_message();
  problem.mutable_spec()->set_frame_problem_sha256(put("{}"));
  v1::SubmitJobResponse response;
  ASSERT_TRUE(submit(problem, &response).ok());
  EXPECT_EQ(response.job().state(), v1::JOB_STATE_QUEUED);
  problem.set_validate_only(true);
  ASSERT_TRUE(submit(problem, &response).ok());
  EXPECT_EQ(response.checks(0), "the frame problem is uploaded");
}

TEST_F(SubmitTest, AWarmStartNamesASucceededJobWhoseFilesTheWorkerGetsEvenWhenThatJobIsDeleted) {
  auto warm = request();
  warm.mutable_spec()->set_warm_start_job_id("nobody");
  EXPECT_EQ(submit(warm).error_code(), grpc::StatusCode::NOT_FOUND);
  const std::string earlier = submit();
  warm.mutable_spec()->set_warm_start_job_id(earlier);
  const grpc::Status early = submit(warm);
  EXPECT_EQ(early.error_code(), grpc::StatusCode::FAILED_PRECONDITION);
  EXPECT_NE(early.error_message().find("QUEUED"), std::string::npos) << early.error_message();

  v1::CompleteRequest done = outcome(lease(), v1::JOB_STATE_SUCCEEDED);
  done.clear_files();
  v1::ResultFile& file = *done.add_files();
  file.set_path("sinterstation-hiq/initial-frame.json");
  file.set_sha256(put("a frame"));
  file.set_size_bytes(7);
  ASSERT_TRUE(complete(done).ok());

  auto other_mesh = warm;
  other_mesh.mutable_spec()->set_mesh_sha256(put("another mesh"));
  EXPECT_EQ(submit(other_mesh).error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  ASSERT_TRUE(submit(warm).ok());
  grpc::ClientContext context;
  v1::DeleteJobRequest forget;
  forget.set_job_id(earlier);
  v1::DeleteJobResponse forgotten;
  ASSERT_TRUE(jobs_->DeleteJob(&context, forget, &forgotten).ok());
  restart();
  const v1::Assignment assignment = lease();
  ASSERT_EQ(assignment.warm_start_files_size(), 1);
  EXPECT_EQ(assignment.warm_start_files(0).SerializeAsString(), file.SerializeAsString());
}

TEST_F(SubmitTest, AFullQueueIsResourceExhaustedWithATimeToRetry) {
  server_.reset();
  options_.queue_limit = 1;
  start();
  ASSERT_TRUE(submit(request("first")).ok());
  const grpc::Status status = submit(request("second"));
  EXPECT_EQ(status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  EXPECT_GT(retry_delay(status).value_or(Milliseconds(0)), Milliseconds(0));
  EXPECT_TRUE(submit(request("first")).ok());  // the one that is there already is no new one
}

// google.rpc.Status {8, message, [Any{type, RetryInfo{1 s}}]}, written by hand after googleapis' numbering.
TEST_F(SubmitTest, TheTimeToRetryIsGooglesRetryInfoByteForByte) {
  server_.reset();
  options_.queue_limit = 1;
  start();
  ASSERT_TRUE(submit(request("first")).ok());
  const grpc::Status status = submit(request("second"));
  const auto field = [](char tag, const std::string& bytes) {
    EXPECT_LT(bytes.size(), 128u) << "one byte of length";
    return std::string(1, tag) + static_cast<char>(bytes.size()) + bytes;
  };
  const std::string one_second = field('\x0a', std::string("\x08\x01"));
  const std::string any =
      field('\x0a', "type.googleapis.com/google.rpc.RetryInfo") + field('\x12', one_second);
  EXPECT_EQ(status.error_details(),
            std::string("\x08\x08") + field('\x12', status.error_message()) + field('\x1a', any));
}

TEST_F(SubmitTest, ValidateOnlyChecksAndMakesNoJob) {
  auto checked = request();
  checked.set_validate_only(true);
  v1::SubmitJobResponse response;
  ASSERT_TRUE(submit(checked, &response).ok());
  EXPECT_FALSE(response.has_job());
  EXPECT_GE(response.checks_size(), 3);
  grpc::ClientContext context;
  v1::ListJobsResponse jobs;
  ASSERT_TRUE(jobs_->ListJobs(&context, {}, &jobs).ok());
  EXPECT_EQ(jobs.jobs_size(), 0);
  checked.mutable_spec()->set_priority(1000);
  EXPECT_EQ(submit(checked).error_code(), grpc::StatusCode::INVALID_ARGUMENT);
}

}  // namespace
}  // namespace skinframe::server
