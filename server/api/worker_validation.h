// SPDX-License-Identifier: Apache-2.0
// Whether what a worker sends is well formed. INVALID_ARGUMENT names the field.
#pragma once

#include "absl/status/status.h"
#include "server/artifacts/artifact_store.h"
#include "skinframe/v1/worker.pb.h"

namespace skinframe::server {

absl::Status validate_lease(const v1::LeaseRequest& request);
absl::Status validate_heartbeat(const v1::HeartbeatRequest& request);
absl::Status validate_checkpoint(const v1::CheckpointRequest& request);
absl::Status validate_complete(const v1::CompleteRequest& request);

// INVALID_ARGUMENT: a printer that the job does not ask for, a frame's result of a job of a mesh. Progress
// without a printer is all printers'.
absl::Status printers_are_the_jobs(const v1::JobSpec& spec, const v1::HeartbeatRequest& request);
absl::Status printers_are_the_jobs(const v1::JobSpec& spec, const v1::CompleteRequest& request);

// FAILED_PRECONDITION: a file is not uploaded, or has another size.
absl::Status files_are_there(const v1::CompleteRequest& request, const ArtifactStore& artifacts);

}  // namespace skinframe::server
