// SPDX-License-Identifier: Apache-2.0
// What a call or a duty does to a job, as pure functions of the job as it stands: no I/O, no clock, no lock.
// The store runs them inside its transaction, so nothing can come between the look and the change.
//
// Each returns the change to make, nothing when all is as wished already, or the refusal for the caller.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "absl/status/statusor.h"
#include "server/jobs/attempt_policy.h"
#include "server/jobs/job_record.h"
#include "skinframe/v1/worker.pb.h"

namespace skinframe::server {

using Decision = absl::StatusOr<std::optional<Change>>;

// A new job: QUEUED, with its first event. record holds id, tenant (else the default one), spec, profiles,
// request id and digest.
Change decide_submit(JobRecord record, Time now, const AttemptPolicy& policy);

// A new job that asks for what an earlier one has made: SUCCEEDED at once with that one's results, and its
// only event and its detail say so.
Change decide_reuse(JobRecord record, const JobRecord& earlier, Time now, const AttemptPolicy& policy);

// CancelJob. Queued: CANCELLED at once. Running: cancel_requested; heartbeats tell the worker, and a lease
// that lasts longer than the policy's patience is cut to that, so that a worker that does not obey loses the
// job. Ended: nothing.
Decision decide_cancel(const JobRecord& record, Time now, const AttemptPolicy& policy);

// The worker named takes the queued job.
Change decide_lease(const JobRecord& record, std::int64_t fencing_token, const std::string& worker_id,
                    const std::string& instance_id, Time now, const AttemptPolicy& policy);

// A heartbeat of the token's holder prolongs the lease, and progress and printer results become events.
// Nothing when it brings no news and the lease was prolonged less than a heartbeat's interval ago: that is a
// question whether to stop. ABORTED: the token is no longer the job's. Once the job shall stop the lease is
// not prolonged any more: a worker that does not obey loses it.
Decision decide_heartbeat(const JobRecord& record, const v1::HeartbeatRequest& request, Time now,
                          const AttemptPolicy& policy);

// A checkpoint by the token's holder takes the place of the one before. ABORTED: the token is no longer the
// job's. Nothing when it is there already.
Decision decide_checkpoint(const JobRecord& record, const v1::CheckpointRequest& request);

// Whether the worker shall stop: cancelled, or past the deadline.
bool must_stop(const JobRecord& record, Time now);

// A completion by the token's holder. The same one again is nothing; ABORTED: the token is no longer the
// job's. A finished result is accepted even when the job was to stop meanwhile. CANCELLED without anybody's
// wish is a worker that stops: the job is queued again at once and no attempt is lost. A retryable failure is
// a lost attempt.
Decision decide_complete(const JobRecord& record, const v1::CompleteRequest& request, Time now,
                         const AttemptPolicy& policy);

// The reaper's: a running job whose lease has expired loses its attempt, or ends when it was to stop anyway.
// Nothing when the lease was prolonged meanwhile.
Decision decide_lease_expired(const JobRecord& record, Time now, const AttemptPolicy& policy);

// The deadline duty's: a queued job past its deadline is FAILED, TIMED_OUT. Nothing otherwise; a running one
// is stopped through its heartbeat or its lease.
Decision decide_deadline(const JobRecord& record, Time now);

// The answer with the lease never reached the worker, which hung up: queued again at once, no attempt is
// lost. Nothing when the lease is over meanwhile.
Decision decide_undelivered(const JobRecord& record, std::int64_t fencing_token, Time now);

// Whether a job may start from this earlier one. FAILED_PRECONDITION: it has not succeeded. INVALID_ARGUMENT:
// it is of another mesh, or of a frame problem.
absl::Status permit_warm_start(const JobRecord& earlier, const v1::JobSpec& spec);

// DeleteJob: FAILED_PRECONDITION unless the job has ended.
absl::Status permit_delete(const JobRecord& record);

}  // namespace skinframe::server
