// SPDX-License-Identifier: Apache-2.0
// skinframe.v1.JobService: translates, validates, delegates. What each call promises stands in job.proto.
#pragma once

#include <optional>
#include <string>

#include "server/api/parts.h"
#include "skinframe/v1/job.grpc.pb.h"

namespace skinframe::server {

class JobService final : public v1::JobService::CallbackService {
 public:
  explicit JobService(const Parts& parts) : parts_(parts) {}

  grpc::ServerUnaryReactor* SubmitJob(grpc::CallbackServerContext* context,
                                      const v1::SubmitJobRequest* request,
                                      v1::SubmitJobResponse* response) override;
  grpc::ServerUnaryReactor* GetJob(grpc::CallbackServerContext* context, const v1::GetJobRequest* request,
                                   v1::Job* response) override;
  grpc::ServerUnaryReactor* ListJobs(grpc::CallbackServerContext* context, const v1::ListJobsRequest* request,
                                     v1::ListJobsResponse* response) override;
  grpc::ServerUnaryReactor* CancelJob(grpc::CallbackServerContext* context,
                                      const v1::CancelJobRequest* request, v1::Job* response) override;
  grpc::ServerUnaryReactor* DeleteJob(grpc::CallbackServerContext* context,
                                      const v1::DeleteJobRequest* request,
                                      v1::DeleteJobResponse* response) override;
  grpc::ServerWriteReactor<v1::JobEvent>* WatchJob(grpc::CallbackServerContext* context,
                                                   const v1::WatchJobRequest* request) override;

 private:
  absl::Status submit(grpc::CallbackServerContext& context, const v1::SubmitJobRequest& request,
                      v1::SubmitJobResponse& response);
  absl::Status list(const std::string& tenant, const v1::ListJobsRequest& request,
                    v1::ListJobsResponse& response);
  JobRecord new_record(const v1::SubmitJobRequest& request, const std::string& tenant,
                       const Catalog& catalog);
  absl::Status take_warm_start(JobRecord& record, ArtifactStore& artifacts);
  absl::StatusOr<std::optional<JobRecord>> find_reusable(const JobRecord& record, ArtifactStore& artifacts);

  Parts parts_;
};

}  // namespace skinframe::server
