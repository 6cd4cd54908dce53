// SPDX-License-Identifier: Apache-2.0
// Who calls: whose jobs and artifacts a call may see.
#pragma once

#include <grpcpp/grpcpp.h>

#include <string>

#include "absl/status/statusor.h"
#include "server/api/parts.h"
#include "server/jobs/job_record.h"
#include "server/tenants/tenant_directory.h"

namespace skinframe::server {

// What the connection and the metadata of the call prove.
Caller caller_of(const grpc::CallbackServerContext& context);

// UNAUTHENTICATED.
absl::StatusOr<std::string> tenant_of(const Parts& parts, const grpc::CallbackServerContext& context);

// PERMISSION_DENIED: the caller is no worker.
absl::Status permit_work(const Parts& parts, const grpc::CallbackServerContext& context);

// NOT_FOUND, in the words of a job that does not exist: another tenant's.
absl::Status check_owner(const JobRecord& record, const std::string& tenant);

// The artifacts that a call is about: those of the caller's tenant, or, for a worker that names a job it
// runs, those of that job's.
struct Shelf {
  ArtifactStore* store = nullptr;
  std::string tenant;
  bool for_a_job = false;  // of a worker: results are taken whatever the quota says, but they count

  // RESOURCE_EXHAUSTED: with so many bytes more the tenant would have more than its quota.
  absl::Status permit_upload(const Parts& parts, const std::string& sha256, std::int64_t size_bytes) const;
};

// UNAUTHENTICATED, PERMISSION_DENIED; ABORTED: the token is not that of the job's lease any more.
absl::StatusOr<Shelf> shelf_of(const Parts& parts, const grpc::CallbackServerContext& context);

}  // namespace skinframe::server
