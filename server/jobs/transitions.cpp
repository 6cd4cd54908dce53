// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/transitions.h"

#include <array>

namespace skinframe::server {
namespace {

constexpr std::array kTransitions = {
    Transition{v1::JOB_STATE_QUEUED, Trigger::kLeased, v1::JOB_STATE_RUNNING},
    Transition{v1::JOB_STATE_QUEUED, Trigger::kCancelled, v1::JOB_STATE_CANCELLED},
    Transition{v1::JOB_STATE_QUEUED, Trigger::kDeadlinePassed, v1::JOB_STATE_FAILED},
    Transition{v1::JOB_STATE_RUNNING, Trigger::kSucceeded, v1::JOB_STATE_SUCCEEDED},
    Transition{v1::JOB_STATE_RUNNING, Trigger::kFailed, v1::JOB_STATE_FAILED},
    Transition{v1::JOB_STATE_RUNNING, Trigger::kAttemptLost, v1::JOB_STATE_QUEUED},
    Transition{v1::JOB_STATE_RUNNING, Trigger::kHandedBack, v1::JOB_STATE_QUEUED},
    Transition{v1::JOB_STATE_RUNNING, Trigger::kAttemptsUsedUp, v1::JOB_STATE_FAILED},
    Transition{v1::JOB_STATE_RUNNING, Trigger::kCancelled, v1::JOB_STATE_CANCELLED},
    Transition{v1::JOB_STATE_RUNNING, Trigger::kDeadlinePassed, v1::JOB_STATE_FAILED},
};

constexpr std::array kTriggers = {Trigger::kLeased,      Trigger::kSucceeded,     Trigger::kFailed,
                                  Trigger::kAttemptLost, Trigger::kHandedBack,    Trigger::kAttemptsUsedUp,
                                  Trigger::kCancelled,   Trigger::kDeadlinePassed};

}  // namespace

std::span<const Transition> all_transitions() { return kTransitions; }
std::span<const Trigger> all_triggers() { return kTriggers; }

std::optional<v1::JobState> next_state(v1::JobState from, Trigger trigger) {
  for (const Transition& transition : kTransitions) {
    if (transition.from == from && transition.trigger == trigger) return transition.to;
  }
  return std::nullopt;
}

bool is_final(v1::JobState state) {
  return state == v1::JOB_STATE_SUCCEEDED || state == v1::JOB_STATE_FAILED ||
         state == v1::JOB_STATE_CANCELLED;
}

std::string_view state_name(v1::JobState state) {
  std::string_view name = v1::JobState_Name(state);  // static storage: protobuf's own table
  constexpr std::string_view kPrefix = "JOB_STATE_";
  if (name.starts_with(kPrefix)) name.remove_prefix(kPrefix.size());
  return name;
}

std::string_view reason_name(v1::Reason reason) {
  if (reason == v1::REASON_UNSPECIFIED) return "NONE";
  std::string_view name = v1::Reason_Name(reason);
  constexpr std::string_view kPrefix = "REASON_";
  if (name.starts_with(kPrefix)) name.remove_prefix(kPrefix.size());
  return name;
}

std::string_view trigger_name(Trigger trigger) {
  switch (trigger) {
    case Trigger::kLeased:
      return "leased";
    case Trigger::kSucceeded:
      return "succeeded";
    case Trigger::kFailed:
      return "failed";
    case Trigger::kAttemptLost:
      return "attempt lost";
    case Trigger::kHandedBack:
      return "handed back";
    case Trigger::kAttemptsUsedUp:
      return "attempts used up";
    case Trigger::kCancelled:
      return "cancelled";
    case Trigger::kDeadlinePassed:
      return "deadline passed";
  }
  return "unknown";
}

}  // namespace skinframe::server
