// SPDX-License-Identifier: Apache-2.0
#include "server/api/worker_service.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <string>
#include <utility>

#include "server/api/answer.h"
#include "server/api/caller.h"
#include "server/api/lease_call.h"
#include "server/api/worker_validation.h"
#include "server/jobs/decisions.h"

namespace skinframe::server {
namespace {

// A late worker is harmless, and still worth a line: it tells of a partition or of a lease that is too short.
absl::Status log_refusal(const absl::Status& status, const std::string& job_id, const char* call) {
  if (absl::IsAborted(status))
    spdlog::warn("job={} {} refused: {}", job_id, call, std::string(status.message()));
  return status;
}

// A worker may hold a token of a job that was deleted meanwhile: its token is the job's no longer.
absl::Status gone_is_aborted(const absl::Status& status) {
  return absl::IsNotFound(status) ? absl::AbortedError(status.message()) : status;
}

}  // namespace

grpc::ServerUnaryReactor* WorkerService::Lease(grpc::CallbackServerContext* context,
                                               const v1::LeaseRequest* request, v1::LeaseResponse* response) {
  return LeaseCall::start(parts_, permit_work(parts_, *context), *request, *response);
}

grpc::ServerUnaryReactor* WorkerService::Heartbeat(grpc::CallbackServerContext* context,
                                                   const v1::HeartbeatRequest* request,
                                                   v1::HeartbeatResponse* response) {
  return answer_on(
      parts_.executor, context,
      [=, this] {
        const absl::Status permitted = permit_work(parts_, *context);
        return permitted.ok() ? log_refusal(heartbeat(*request, *response), request->job_id(), "heartbeat")
                              : permitted;
      },
      request->job_id());
}

absl::Status WorkerService::heartbeat(const v1::HeartbeatRequest& request, v1::HeartbeatResponse& response) {
  if (auto status = validate_heartbeat(request); !status.ok()) return status;
  const Time now = parts_.clock.now();
  const auto decide = [&](const JobRecord& record) -> Decision {
    Decision decision = decide_heartbeat(record, request, now, parts_.policy);
    if (!decision.ok()) return decision;  // a late worker hears of its token first
    if (auto status = printers_are_the_jobs(record.job.spec(), request); !status.ok()) return status;
    return decision;
  };
  auto after = look_first(request, decide);
  if (!after.ok()) return gone_is_aborted(after.status());
  response.set_cancel(must_stop(*after, now));
  *response.mutable_lease_left() = to_duration(std::max(Milliseconds(0), after->lease.expires - now));
  *response.mutable_lease_expire_time() = to_timestamp(after->lease.expires);
  return absl::OkStatus();
}

// Most heartbeats only ask whether to stop: these cost a read, and neither a lock nor a commit.
absl::StatusOr<JobRecord> WorkerService::look_first(const v1::HeartbeatRequest& request,
                                                    const Decide& decide) {
  if (request.progress_size() > 0 || request.printers_size() > 0)
    return parts_.store.modify(request.job_id(), decide);
  auto record = parts_.store.get(request.job_id());
  if (!record.ok()) return record;
  const Decision decision = decide(*record);
  if (!decision.ok()) return decision.status();
  return decision->has_value() ? parts_.store.modify(request.job_id(), decide) : std::move(record);
}

grpc::ServerUnaryReactor* WorkerService::Checkpoint(grpc::CallbackServerContext* context,
                                                    const v1::CheckpointRequest* request,
                                                    v1::CheckpointResponse*) {
  return answer_on(
      parts_.executor, context,
      [=, this] {
        const absl::Status permitted = permit_work(parts_, *context);
        return permitted.ok() ? log_refusal(checkpoint(*request), request->job_id(), "checkpoint")
                              : permitted;
      },
      request->job_id());
}

absl::Status WorkerService::checkpoint(const v1::CheckpointRequest& request) {
  if (auto status = validate_checkpoint(request); !status.ok()) return status;
  const auto job = parts_.store.get(request.job_id());
  if (!job.ok()) return gone_is_aborted(job.status());
  const auto artifacts = parts_.artifacts.of(job->job.tenant());
  if (!artifacts.ok()) return artifacts.status();
  const auto facts = (*artifacts)->stat(request.checkpoint().sha256());
  const auto after = parts_.store.modify(request.job_id(), [&](const JobRecord& record) -> Decision {
    Decision decision = decide_checkpoint(record, request);
    if (!decision.ok()) return decision;  // a late worker hears of its token first
    if (!facts.ok()) return facts.status();
    if (!facts->complete || facts->size_bytes != request.checkpoint().size_bytes())
      return absl::FailedPreconditionError("checkpoint: no artifact of this name and size is uploaded");
    return decision;
  });
  return gone_is_aborted(after.status());
}

grpc::ServerUnaryReactor* WorkerService::Complete(grpc::CallbackServerContext* context,
                                                  const v1::CompleteRequest* request, v1::CompleteResponse*) {
  return answer_on(
      parts_.executor, context,
      [=, this] {
        const absl::Status permitted = permit_work(parts_, *context);
        return permitted.ok() ? log_refusal(complete(*request), request->job_id(), "completion") : permitted;
      },
      request->job_id());
}

absl::Status WorkerService::complete(const v1::CompleteRequest& request) {
  if (auto status = validate_complete(request); !status.ok()) return status;
  const auto job = parts_.store.get(request.job_id());
  if (!job.ok()) return gone_is_aborted(job.status());
  const auto artifacts = parts_.artifacts.of(job->job.tenant());
  if (!artifacts.ok()) return artifacts.status();
  const absl::Status files = files_are_there(request, **artifacts);
  const Time now = parts_.clock.now();
  const auto after = parts_.store.modify(request.job_id(), [&](const JobRecord& record) -> Decision {
    Decision decision = decide_complete(record, request, now, parts_.policy);
    const bool accepted = decision.ok() && decision->has_value();
    if (!accepted) return decision;  // a late worker hears of its token first
    if (auto status = printers_are_the_jobs(record.job.spec(), request); !status.ok()) return status;
    if (!files.ok()) return files;
    return decision;
  });
  return gone_is_aborted(after.status());
}

}  // namespace skinframe::server
