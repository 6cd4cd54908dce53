// SPDX-License-Identifier: Apache-2.0
// GetJob, ListJobs, CancelJob, DeleteJob and the catalog.
#include "tests/server/api/api_fixture.h"

namespace skinframe::server {
namespace {

class JobServiceTest : public ApiTest {
 protected:
  grpc::Status list(const v1::ListJobsRequest& request, v1::ListJobsResponse* response) {
    grpc::ClientContext context;
    set_deadline(context);
    return jobs_->ListJobs(&context, request, response);
  }
  grpc::Status remove(const std::string& job_id) {
    grpc::ClientContext context;
    set_deadline(context);
    v1::DeleteJobRequest request;
    request.set_job_id(job_id);
    v1::DeleteJobResponse response;
    return jobs_->DeleteJob(&context, request, &response);
  }
};

TEST_F(JobServiceTest, UnknownJobsAreNotFound) {
  grpc::ClientContext context;
  v1::GetJobRequest request;
  request.set_job_id("none");
  v1::Job ignored;
  EXPECT_EQ(jobs_->GetJob(&context, request, &ignored).error_code(), grpc::StatusCode::NOT_FOUND);
  EXPECT_EQ(cancel("none").error_code(), grpc::StatusCode::NOT_FOUND);
  EXPECT_EQ(remove("none").error_code(), grpc::StatusCode::NOT_FOUND);
}

TEST_F(JobServiceTest, ListGoesThroughAllPagesNewestFirst) {
  std::vector<std::string> submitted;
  for (int i = 0; i < 5; ++i) submitted.insert(submitted.begin(), submit());
  v1::ListJobsRequest request;
  request.set_page_size(2);
  std::vector<std::string> seen;
  do {
    v1::ListJobsResponse page;
    ASSERT_TRUE(list(request, &page).ok());
    for (const auto& job : page.jobs()) seen.push_back(job.job_id());
    request.set_page_token(page.next_page_token());
  } while (!request.page_token().empty());
  EXPECT_EQ(seen, submitted);
}

TEST_F(JobServiceTest, WrongPagesAreInvalidArguments) {
  v1::ListJobsResponse page;
  for (const int size : {-1, 501}) {
    v1::ListJobsRequest request;
    request.set_page_size(size);
    EXPECT_EQ(list(request, &page).error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  }
  for (const char* token : {"x", "-1", "0", "1x", "99999999999999999999"}) {
    v1::ListJobsRequest request;
    request.set_page_token(token);
    EXPECT_EQ(list(request, &page).error_code(), grpc::StatusCode::INVALID_ARGUMENT) << token;
  }
}

TEST_F(JobServiceTest, CancelEndsAQueuedJobAndLeavesAnEndedOne) {
  const std::string id = submit();
  ASSERT_TRUE(cancel(id).ok());
  EXPECT_EQ(job(id).state(), v1::JOB_STATE_CANCELLED);
  EXPECT_EQ(job(id).reason(), v1::REASON_CANCELLED);
  const auto events = job(id).last_sequence();
  EXPECT_TRUE(cancel(id).ok());
  EXPECT_EQ(job(id).last_sequence(), events);
}

TEST_F(JobServiceTest, DeleteNeedsAnEndedJob) {
  const std::string id = submit();
  EXPECT_EQ(remove(id).error_code(), grpc::StatusCode::FAILED_PRECONDITION);
  ASSERT_TRUE(cancel(id).ok());
  EXPECT_TRUE(remove(id).ok());
  EXPECT_EQ(remove(id).error_code(), grpc::StatusCode::NOT_FOUND);
}

TEST_F(JobServiceTest, TheCatalogListsTheBuiltInProfiles) {
  grpc::ClientContext printers_context;
  v1::ListPrintersResponse printers;
  ASSERT_TRUE(catalog_->ListPrinters(&printers_context, {}, &printers).ok());
  ASSERT_GE(printers.printers_size(), 6);
  EXPECT_EQ(printers.printers(0).id(), "bambu-x1-carbon") << "in the order of their ids";
  grpc::ClientContext materials_context;
  v1::ListMaterialsResponse materials;
  ASSERT_TRUE(catalog_->ListMaterials(&materials_context, {}, &materials).ok());
  EXPECT_GE(materials.materials_size(), 6);
}

TEST_F(JobServiceTest, AQueuedJobKeepsTheProfileItWasSubmittedWith) {
  test::TemporaryFolder profiles;
  const auto write = [&](double radius) {
    profiles.write("mine.json", R"({"printer": {"id": "mine", "display_name": "Mine", "process": "powder",
      "default_material_id": "pa", "max_internal_radius_mm": 5, "tray_x_mm": 100, "tray_y_mm": 100,
      "tray_z_mm": 100, "source": "s", "min_radius_mm": )" +
                                    std::to_string(radius) + "}}");
  };
  write(0.5);
  options_.profiles = profiles.path();
  restart();
  v1::SubmitJobRequest request;
  *request.mutable_spec() = spec();
  request.mutable_spec()->mutable_printers(0)->set_printer_id("mine");
  ASSERT_TRUE(submit(request).ok());
  write(0.625);
  restart();
  const v1::Assignment assignment = lease();
  ASSERT_EQ(assignment.printers_size(), 1);
  EXPECT_EQ(assignment.printers(0).min_radius_mm(), 0.5);
}

}  // namespace
}  // namespace skinframe::server
