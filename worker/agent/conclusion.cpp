// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/agent/conclusion.h"

#include <fmt/format.h>
#include <signal.h>

#include <utility>

namespace skinframe::agent {

Conclusion failed(v1::Reason reason, std::string detail, bool retryable) {
  Conclusion out;
  out.outcome.state = v1::JOB_STATE_FAILED;
  out.outcome.reason = reason;
  out.outcome.detail = std::move(detail);
  out.retryable = retryable;
  return out;
}

namespace {

Conclusion cancelled() {
  Conclusion out;
  out.outcome.state = v1::JOB_STATE_CANCELLED;
  out.outcome.reason = v1::REASON_CANCELLED;
  out.outcome.detail = "cancelled while it ran";
  return out;
}

// CANCELLED that nobody asked for: the server queues the job again, and no attempt counts as lost.
Conclusion handed_back() {
  Conclusion out;
  out.outcome.state = v1::JOB_STATE_CANCELLED;
  out.outcome.detail = "worker stopped";
  return out;
}

std::string last_words(const AttemptEnd& end) {
  return end.last_log_lines.empty() ? std::string() : "; its last words: " + end.last_log_lines;
}

// An allocation that fails outside any stage ends in terminate(); the C++ runtime then names the exception.
// Below a limit of address space a thread may have no room for its stack either, nor a library for itself.
bool starved(const AttemptEnd& end) {
  const auto said = [&](const char* words) { return end.last_log_lines.find(words) != std::string::npos; };
  if (end.exit.signal == SIGABRT && said("std::bad_alloc")) return true;
  return end.memory_limit_mb > 0 &&
         (said("Resource temporarily unavailable") || said("Cannot allocate memory"));
}

Conclusion crashed(const AttemptEnd& end) {
  if (starved(end)) {
    return failed(v1::REASON_OUT_OF_MEMORY,
                  end.memory_limit_mb > 0 ? fmt::format("the job needs more than the worker's limit of {} MB",
                                                        end.memory_limit_mb)
                                          : "the job needs more memory than the worker has",
                  true);
  }
  std::string how = end.exit.signal != 0
                        ? "the job's process was ended by " + signal_name(end.exit.signal)
                        : fmt::format("the job's process left with code {}", end.exit.exit_code);
  if (end.exit.signal == SIGKILL) how += " (often the system's want of memory)";
  if (!end.outcome_error.empty()) how += "; " + end.outcome_error;
  return failed(v1::REASON_CRASHED, how + last_words(end), true);
}

}  // namespace

Conclusion conclude(const AttemptEnd& end) {
  if (end.stop == StopCause::kLeaseLost) {
    Conclusion out = failed(v1::REASON_CRASHED, "the lease was lost", true);
    out.report = false;
    return out;
  }
  const bool whole = end.outcome && end.outcome->state != v1::JOB_STATE_CANCELLED;
  if (whole) {
    Conclusion out;
    out.outcome = *end.outcome;
    const bool attempt_failed =
        out.outcome.state == v1::JOB_STATE_FAILED &&
        (out.outcome.reason == v1::REASON_OUT_OF_MEMORY || out.outcome.reason == v1::REASON_CRASHED);
    out.retryable = attempt_failed;
    out.upload = !attempt_failed;
    return out;
  }
  switch (end.stop) {
    case StopCause::kCancelled:
      return cancelled();
    case StopCause::kDeadline:
      return failed(v1::REASON_TIMED_OUT, "the job's deadline passed while it ran", false);
    case StopCause::kWorkerStopped:
      return handed_back();
    case StopCause::kLeaseLost:
    case StopCause::kNone:
      break;
  }
  if (end.outcome) {
    return failed(v1::REASON_CRASHED, "the job's process was told to stop by somebody other than its worker",
                  true);
  }
  return crashed(end);
}

}  // namespace skinframe::agent
