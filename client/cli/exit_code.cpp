// SPDX-License-Identifier: Apache-2.0
#include "client/cli/exit_code.h"

namespace skinframe::client {

ExitCode exit_code(v1::JobState state, v1::Reason reason) {
  if (state == v1::JOB_STATE_SUCCEEDED) return reason == v1::REASON_PARTIAL ? kExitPartial : kExitSuccess;
  if (state == v1::JOB_STATE_CANCELLED) return kExitCancelled;
  if (state != v1::JOB_STATE_FAILED) return kExitFailed;
  switch (reason) {
    case v1::REASON_INVALID_INPUT:
    case v1::REASON_DOES_NOT_FIT:
      return kExitInput;
    case v1::REASON_INFEASIBLE:
      return kExitInfeasible;
    case v1::REASON_CANCELLED:
      return kExitCancelled;
    case v1::REASON_UNSUPPORTED:
      return kExitUsage;  // an option refused by name, only later than usual
    default:
      return kExitFailed;
  }
}

ExitCode exit_code(FailureKind kind) {
  switch (kind) {
    case FailureKind::kUsage:
      return kExitUsage;
    case FailureKind::kInput:
      return kExitInput;
    case FailureKind::kUnreachable:
      return kExitUnreachable;
    case FailureKind::kNotFound:
      return kExitNotFound;
    case FailureKind::kInterrupted:
      return kExitCancelled;
    case FailureKind::kLocal:
    case FailureKind::kInternal:
      return kExitFailed;
  }
  return kExitFailed;
}

}  // namespace skinframe::client
