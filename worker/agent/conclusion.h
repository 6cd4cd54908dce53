// SPDX-License-Identifier: GPL-3.0-or-later
// How an attempt ended: a pure function of why it was stopped, how its process ended and what it left behind.
#pragma once

#include <optional>
#include <string>

#include "worker/agent/child_process.h"
#include "worker/agent/job_event.h"

namespace skinframe::agent {

// Who asked for the end. The first one counts.
enum class StopCause {
  kNone,
  kCancelled,      // the server said so in a heartbeat
  kLeaseLost,      // ABORTED, or no heartbeat came through until the lease's expiry: nobody wants the result
  kDeadline,       // of the job
  kWorkerStopped,  // SIGTERM to the agent: the job is handed back, no attempt is lost
};

struct Conclusion {
  Outcome outcome;
  bool retryable = false;  // the attempt failed, not the job
  bool report = true;      // false: the lease is lost, tell nobody
  bool upload = false;     // WORKDIR/out is the result
};

// The job ends so; retryable: only the attempt does.
Conclusion failed(v1::Reason reason, std::string detail, bool retryable);

struct AttemptEnd {
  StopCause stop = StopCause::kNone;
  ChildExit exit;
  std::optional<Outcome> outcome;  // empty: none was written
  std::string outcome_error;       // why what was written could not be read
  std::string last_log_lines;      // of the child's stderr
  int memory_limit_mb = 0;         // 0: none
};

// A whole result counts even when the stop came a moment later; a crash outside our doing is retryable.
Conclusion conclude(const AttemptEnd& end);

}  // namespace skinframe::agent
