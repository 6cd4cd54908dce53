// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/decisions.h"

#include <fmt/format.h>
#include <google/protobuf/util/message_differencer.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "server/jobs/job_id.h"
#include "server/jobs/transitions.h"

namespace skinframe::server {
namespace {

using google::protobuf::util::MessageDifferencer;

v1::JobEvent event_at(Time now) {
  v1::JobEvent event;
  *event.mutable_time() = to_timestamp(now);
  return event;
}

// Moves the record along the arrow and tells of it. An arrow that the table does not have is a defect of
// ours.
void move_job(Change& change, Trigger trigger, v1::Reason reason, const std::string& detail, Time now) {
  v1::Job& job = change.record.job;
  const auto to = next_state(job.state(), trigger);
  if (!to) {
    std::fprintf(stderr, "job=%s: no transition from %s by '%s'\n", job.job_id().c_str(),
                 std::string(state_name(job.state())).c_str(), std::string(trigger_name(trigger)).c_str());
    std::abort();
  }
  job.set_state(*to);
  job.set_reason(reason);
  job.set_detail(detail);
  if (is_final(*to)) {
    *job.mutable_end_time() = to_timestamp(now);
    job.clear_checkpoint();
  }

  v1::JobEvent event = event_at(now);
  event.mutable_state()->set_state(*to);
  event.mutable_state()->set_reason(reason);
  event.mutable_state()->set_detail(detail);
  event.mutable_state()->set_attempt(job.attempt());
  change.events.push_back(std::move(event));
}

// Takes the results into the job, the newest of a printer in place of the one before; what is new becomes an
// event.
template <class Results>
void take_printer_results(Change& change, const Results& results, Time now) {
  v1::Job& job = change.record.job;
  for (const v1::PrinterResult& result : results) {
    auto& known = *job.mutable_printers();
    const auto same = std::find_if(known.begin(), known.end(), [&](const v1::PrinterResult& other) {
      return other.printer_id() == result.printer_id();
    });
    if (same != known.end() && MessageDifferencer::Equals(*same, result)) continue;
    if (same == known.end()) {
      *known.Add() = result;
    } else {
      *same = result;
    }
    v1::JobEvent event = event_at(now);
    *event.mutable_printer() = result;
    change.events.push_back(std::move(event));
  }
}

absl::Status stale_token(const JobRecord& record, std::int64_t token) {
  return absl::AbortedError(
      fmt::format("token {} is no longer the lease of job {}, which is {}; drop its results", token,
                  record.job.job_id(), state_name(record.job.state())));
}

bool holds_lease(const JobRecord& record, std::int64_t token) {
  return record.job.state() == v1::JOB_STATE_RUNNING && token != 0 && record.lease.fencing_token == token;
}

bool deadline_passed(const JobRecord& record, Time now) { return record.deadline && now >= *record.deadline; }

std::string deadline_detail(const JobRecord& record) {
  const double seconds = static_cast<double>(from_duration(record.job.spec().deadline()).count()) / 1000.0;
  return fmt::format("the deadline of {} s after submission passed", seconds);
}

// The attempt brought no result. Ends the job when it was to stop or has no attempt left; else queues it
// again.
void lose_attempt(Change& change, v1::Reason reason, const std::string& why, Time now,
                  const AttemptPolicy& policy) {
  JobRecord& record = change.record;
  ++record.lost_attempts;
  if (record.job.cancel_requested()) {
    move_job(change, Trigger::kCancelled, v1::REASON_CANCELLED, "cancelled on request", now);
  } else if (deadline_passed(record, now)) {
    move_job(change, Trigger::kDeadlinePassed, v1::REASON_TIMED_OUT, deadline_detail(record), now);
  } else if (record.lost_attempts >= policy.max_attempts) {
    move_job(change, Trigger::kAttemptsUsedUp, reason,
             fmt::format("no result after {} attempt{}; the last: {}", record.lost_attempts,
                         record.lost_attempts == 1 ? "" : "s", why),
             now);
  } else {
    const Milliseconds rest =
        backoff_after(record.lost_attempts, jitter_of(record.job.job_id(), record.lost_attempts), policy);
    record.not_before = now + rest;
    record.job.clear_printers();  // the next attempt starts from nothing
    move_job(change, Trigger::kAttemptLost, v1::REASON_UNSPECIFIED,
             fmt::format("attempt {} of {} lost: {}; queued again after {:.1f} s", record.lost_attempts,
                         policy.max_attempts, why, static_cast<double>(rest.count()) / 1000.0),
             now);
  }
}

// A worker that stops gives its job back in good order: the job is not to blame, so that no attempt counts as
// lost and nothing rests.
void hand_back(Change& change, const std::string& why, Time now) {
  JobRecord& record = change.record;
  record.not_before = now;
  record.job.clear_printers();  // the next attempt starts from nothing
  move_job(change, Trigger::kHandedBack, v1::REASON_UNSPECIFIED, why, now);
}

}  // namespace

Change decide_submit(JobRecord record, Time now, const AttemptPolicy& policy) {
  Change change{std::move(record), {}};
  v1::Job& job = change.record.job;
  if (job.tenant().empty()) job.set_tenant(kDefaultTenant);
  job.set_state(v1::JOB_STATE_QUEUED);
  *job.mutable_create_time() = to_timestamp(now);
  change.record.rank_ms = rank_ms(now, job.spec().priority(), policy);
  if (job.spec().has_deadline()) change.record.deadline = now + from_duration(job.spec().deadline());
  v1::JobEvent event = event_at(now);
  event.mutable_state()->set_state(v1::JOB_STATE_QUEUED);
  change.events.push_back(std::move(event));
  return change;
}

Change decide_reuse(JobRecord record, const JobRecord& earlier, Time now, const AttemptPolicy& policy) {
  Change change = decide_submit(std::move(record), now, policy);
  v1::Job& job = change.record.job;
  const v1::Job& made = earlier.job;
  job.set_state(v1::JOB_STATE_SUCCEEDED);
  job.set_reused_job_id(made.reused_job_id().empty() ? made.job_id() : made.reused_job_id());
  job.set_detail(fmt::format("not run: the result of job {}, which asked for the same", job.reused_job_id()));
  *job.mutable_printers() = made.printers();
  *job.mutable_files() = made.files();
  if (made.has_frame()) *job.mutable_frame() = made.frame();
  *job.mutable_end_time() = to_timestamp(now);
  v1::StateChange& event = *change.events.front().mutable_state();
  event.set_state(job.state());
  event.set_detail(job.detail());
  return change;
}

Decision decide_cancel(const JobRecord& record, Time now, const AttemptPolicy& policy) {
  if (is_final(record.job.state()) || record.job.cancel_requested()) return std::nullopt;
  Change change{record, {}};
  change.record.job.set_cancel_requested(true);
  if (record.job.state() == v1::JOB_STATE_QUEUED) {
    move_job(change, Trigger::kCancelled, v1::REASON_CANCELLED, "cancelled on request", now);
  } else {
    change.record.lease.expires = std::min(record.lease.expires, now + policy.cancel_patience);
  }
  return change;
}

Change decide_lease(const JobRecord& record, std::int64_t fencing_token, const std::string& worker_id,
                    const std::string& instance_id, Time now, const AttemptPolicy& policy) {
  Change change{record, {}};
  JobRecord& next = change.record;
  next.lease = Lease{fencing_token, worker_id, instance_id, now + policy.lease};
  next.completion_digest.clear();
  next.job.set_attempt(record.job.attempt() + 1);
  *next.job.mutable_start_time() = to_timestamp(now);
  move_job(change, Trigger::kLeased, v1::REASON_UNSPECIFIED, "", now);
  return change;
}

bool must_stop(const JobRecord& record, Time now) {
  return record.job.cancel_requested() || deadline_passed(record, now);
}

Decision decide_heartbeat(const JobRecord& record, const v1::HeartbeatRequest& request, Time now,
                          const AttemptPolicy& policy) {
  if (!holds_lease(record, request.fencing_token())) return stale_token(record, request.fencing_token());
  const bool news = request.progress_size() > 0 || request.printers_size() > 0;
  // A lease that lasts longer than one can be given is of before the clock was set back: not fresh.
  const Milliseconds left = record.lease.expires - now;
  const bool fresh = policy.lease - policy.heartbeat < left && left <= policy.lease;
  if (!news && (fresh || must_stop(record, now))) return std::nullopt;
  Change change{record, {}};
  if (!must_stop(record, now)) change.record.lease.expires = now + policy.lease;
  for (const v1::JobProgress& progress : request.progress()) {
    v1::JobEvent event = event_at(now);
    *event.mutable_progress() = progress;
    event.mutable_progress()->set_attempt(record.job.attempt());
    change.events.push_back(std::move(event));
  }
  take_printer_results(change, request.printers(), now);
  return change;
}

Decision decide_checkpoint(const JobRecord& record, const v1::CheckpointRequest& request) {
  if (!holds_lease(record, request.fencing_token())) return stale_token(record, request.fencing_token());
  v1::Checkpoint checkpoint = request.checkpoint();
  checkpoint.set_attempt(record.job.attempt());
  if (MessageDifferencer::Equals(checkpoint, record.job.checkpoint())) return std::nullopt;
  Change change{record, {}};
  *change.record.job.mutable_checkpoint() = std::move(checkpoint);
  return change;
}

Decision decide_complete(const JobRecord& record, const v1::CompleteRequest& request, Time now,
                         const AttemptPolicy& policy) {
  const std::string digest = sha256_hex(request.SerializeAsString());
  const bool repeated = record.lease.fencing_token == request.fencing_token() &&
                        record.job.state() != v1::JOB_STATE_RUNNING && record.completion_digest == digest;
  if (repeated) return std::nullopt;
  if (!holds_lease(record, request.fencing_token())) return stale_token(record, request.fencing_token());

  Change change{record, {}};
  change.record.completion_digest = digest;
  if (request.state() == v1::JOB_STATE_CANCELLED) {
    if (!must_stop(record, now)) {
      hand_back(change, "its worker stopped; queued again", now);
      return change;
    }
    take_printer_results(change, request.printers(), now);
    lose_attempt(change, v1::REASON_CRASHED, "its worker stopped it", now, policy);
    return change;
  }
  if (request.retryable()) {
    // It may be the checkpoint itself that the process dies of.
    const bool got_no_further = record.job.checkpoint().attempt() < record.job.attempt();
    if (got_no_further) change.record.job.clear_checkpoint();
    const std::string why =
        request.detail().empty() ? std::string(reason_name(request.reason())) : request.detail();
    lose_attempt(change, request.reason(), why, now, policy);
    return change;
  }
  take_printer_results(change, request.printers(), now);
  *change.record.job.mutable_printers() = request.printers();  // all of them, in the worker's order
  *change.record.job.mutable_files() = request.files();
  if (request.has_frame()) *change.record.job.mutable_frame() = request.frame();
  const bool succeeded = request.state() == v1::JOB_STATE_SUCCEEDED;
  move_job(change, succeeded ? Trigger::kSucceeded : Trigger::kFailed, request.reason(), request.detail(),
           now);
  return change;
}

Decision decide_lease_expired(const JobRecord& record, Time now, const AttemptPolicy& policy) {
  if (record.job.state() != v1::JOB_STATE_RUNNING || record.lease.expires > now) return std::nullopt;
  Change change{record, {}};
  lose_attempt(change, v1::REASON_CRASHED,
               fmt::format("no heartbeat from worker {} before its lease ended", record.lease.worker_id), now,
               policy);
  return change;
}

Decision decide_undelivered(const JobRecord& record, std::int64_t fencing_token, Time now) {
  if (!holds_lease(record, fencing_token)) return std::nullopt;
  Change change{record, {}};
  if (must_stop(record, now)) {
    change.record.lease.expires = now;  // the reaper ends it as it ends any job that was to stop
    return change;
  }
  hand_back(change, "its worker hung up before the job reached it; queued again", now);
  return change;
}

Decision decide_deadline(const JobRecord& record, Time now) {
  if (record.job.state() != v1::JOB_STATE_QUEUED || !deadline_passed(record, now)) return std::nullopt;
  Change change{record, {}};
  move_job(change, Trigger::kDeadlinePassed, v1::REASON_TIMED_OUT,
           deadline_detail(record) + " while it was queued", now);
  return change;
}

absl::Status permit_warm_start(const JobRecord& earlier, const v1::JobSpec& spec) {
  const v1::Job& job = earlier.job;
  if (!job.spec().has_mesh_sha256() || job.spec().mesh_sha256() != spec.mesh_sha256()) {
    return absl::InvalidArgumentError(
        fmt::format("warm_start_job_id: job {} is of {}; a warm start needs one of the same mesh",
                    job.job_id(), job.spec().has_mesh_sha256() ? "another mesh" : "a frame problem"));
  }
  if (job.state() != v1::JOB_STATE_SUCCEEDED) {
    return absl::FailedPreconditionError(
        fmt::format("warm_start_job_id: job {} is {}; a warm start needs one that SUCCEEDED", job.job_id(),
                    state_name(job.state())));
  }
  return absl::OkStatus();
}

absl::Status permit_delete(const JobRecord& record) {
  if (is_final(record.job.state())) return absl::OkStatus();
  return absl::FailedPreconditionError(fmt::format("job {} is {}: cancel it before deleting it",
                                                   record.job.job_id(), state_name(record.job.state())));
}

}  // namespace skinframe::server
