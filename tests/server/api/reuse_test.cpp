// SPDX-License-Identifier: Apache-2.0
// What was made once is not made again, unless it is asked for.
#include <filesystem>

#include "tests/server/api/api_fixture.h"

namespace skinframe::server {
namespace {

class Reuse : public ApiTest {
 protected:
  v1::Job submitted(const v1::SubmitJobRequest& request) {
    v1::SubmitJobResponse response;
    const grpc::Status status = submit(request, &response);
    EXPECT_TRUE(status.ok()) << status.error_message();
    return response.job();
  }
  v1::SubmitJobRequest request() {
    v1::SubmitJobRequest request;
    *request.mutable_spec() = spec();
    return request;
  }
  // Submits and runs the job to its end, with one file.
  std::string made(const v1::SubmitJobRequest& wanted, v1::Reason reason = v1::REASON_UNSPECIFIED) {
    const std::string id = submitted(wanted).job_id();
    v1::CompleteRequest done = outcome(lease(), v1::JOB_STATE_SUCCEEDED, reason);
    v1::ResultFile& file = *done.add_files();
    file.set_path("report.json");
    file.set_sha256(put("a report"));
    file.set_size_bytes(8);
    done.add_printers()->set_printer_id("sinterstation-hiq");
    EXPECT_TRUE(complete(done).ok());
    return id;
  }
};

TEST_F(Reuse, TheSameAgainEndsAtOnceWithTheEarlierResultAndSaysWhose) {
  const std::string first = made(request());
  auto again = request();
  again.mutable_spec()->set_mesh_name("another name.obj");
  again.mutable_spec()->set_priority(7);
  (*again.mutable_spec()->mutable_labels())["order"] = "2";
  again.mutable_spec()->mutable_printers(0)->set_material_id("pa");  // the printer's default, written out
  const v1::Job second = submitted(again);
  EXPECT_EQ(second.state(), v1::JOB_STATE_SUCCEEDED);
  EXPECT_EQ(second.reused_job_id(), first);
  EXPECT_NE(second.job_id(), first);
  ASSERT_EQ(second.files_size(), 1);
  EXPECT_EQ(second.files(0).sha256(), sha256_hex("a report"));
  EXPECT_EQ(second.printers_size(), 1);
  EXPECT_EQ(second.spec().mesh_name(), "another name.obj");
  std::vector<v1::JobEvent> events;
  EXPECT_TRUE(watch(second.job_id(), 0, &events).ok());
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].state().state(), v1::JOB_STATE_SUCCEEDED);
  EXPECT_NE(events[0].state().detail().find(first), std::string::npos);
}

TEST_F(Reuse, ItIsRunWhenThatIsAskedFor) {
  made(request());
  auto again = request();
  again.set_no_reuse(true);
  EXPECT_EQ(submitted(again).state(), v1::JOB_STATE_QUEUED);
}

TEST_F(Reuse, WhateverChangesTheResultIsRun) {
  made(request());
  auto other = request();
  other.mutable_spec()->mutable_options()->set_seed(2);
  EXPECT_EQ(submitted(other).state(), v1::JOB_STATE_QUEUED);
  other = request();
  other.mutable_spec()->set_mesh_sha256(put("another mesh"));
  EXPECT_EQ(submitted(other).state(), v1::JOB_STATE_QUEUED);
  other = request();
  other.mutable_spec()->mutable_printers(0)->set_material_id("pla");
  EXPECT_EQ(submitted(other).state(), v1::JOB_STATE_QUEUED);
}

TEST_F(Reuse, OnlyAWholeResultIsReused) {
  made(request(), v1::REASON_PARTIAL);
  EXPECT_EQ(submitted(request()).state(), v1::JOB_STATE_QUEUED);
}

TEST_F(Reuse, AResultWhoseFilesAreGoneIsMadeAgain) {
  made(request());
  const std::string sha256 = sha256_hex("a report");
  ASSERT_TRUE(
      std::filesystem::remove(folder_.path() / "artifacts" / "complete" / sha256.substr(0, 2) / sha256));
  EXPECT_EQ(submitted(request()).state(), v1::JOB_STATE_QUEUED);
}

TEST_F(Reuse, ARepeatedSubmissionIsItsOwnJobAndNoReuse) {
  auto wanted = request();
  wanted.set_request_id("r");
  const std::string first = made(wanted);
  const v1::Job again = submitted(wanted);
  EXPECT_EQ(again.job_id(), first);
  EXPECT_TRUE(again.reused_job_id().empty());
}

TEST_F(Reuse, ValidateOnlyTellsOfIt) {
  const std::string first = made(request());
  auto asked = request();
  asked.set_validate_only(true);
  v1::SubmitJobResponse response;
  ASSERT_TRUE(submit(asked, &response).ok());
  EXPECT_NE(response.checks(response.checks_size() - 1).find(first), std::string::npos);
}

}  // namespace
}  // namespace skinframe::server
