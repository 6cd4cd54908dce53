// SPDX-License-Identifier: Apache-2.0
// The life of a job, as data. Every change of state in the server goes through next_state(); what is not in
// the table cannot happen.
//
//   state      who moves a job into it                       after a crash of the server
//   QUEUED     SubmitJob; the lease reaper or a retryable    still queued: the row is the queue
//              Complete when attempts are left; a worker
//              that stops and hands the job back
//   RUNNING    Lease, with a new fencing token               still running: the store holds the worker's
//                                                            token; its heartbeats go on, and without them
//                                                            the lease expires
//   SUCCEEDED  Complete by the token's holder                final
//   FAILED     Complete, the lease reaper when attempts are  final
//              used up, the deadline duty
//   CANCELLED  CancelJob on a queued job; Complete or the    final
//              lease reaper on a running one
#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "skinframe/v1/job.pb.h"

namespace skinframe::server {

// What happens to a job. The name says who saw it.
enum class Trigger {
  kLeased,          // a worker took the job
  kSucceeded,       // the worker completed it
  kFailed,          // the worker completed it: the job itself failed, another attempt would not help
  kAttemptLost,     // the attempt ended without a result, and attempts are left
  kHandedBack,      // the worker stopped and gave the job back; no attempt is lost
  kAttemptsUsedUp,  // an attempt ended without a result, and none is left
  kCancelled,       // the user's wish came true: at once when queued, by worker or lease end when running
  kDeadlinePassed,  // found queued by the deadline duty, or stopped by the worker, or its lease ended
};

struct Transition {
  v1::JobState from;
  Trigger trigger;
  v1::JobState to;
};

std::span<const Transition> all_transitions();
std::span<const Trigger> all_triggers();

// The state after the trigger; nothing when the table has no such arrow.
std::optional<v1::JobState> next_state(v1::JobState from, Trigger trigger);

bool is_final(v1::JobState state);
std::string_view state_name(v1::JobState state);  // "QUEUED"
std::string_view reason_name(v1::Reason reason);  // "CRASHED"; "NONE" when unspecified
std::string_view trigger_name(Trigger trigger);   // "lost attempt"

}  // namespace skinframe::server
