// SPDX-License-Identifier: Apache-2.0
// The exit codes of every verb, in one place. The table is part of the contract: scripts read it.
#pragma once

#include "client/call/result.h"
#include "skinframe/v1/job.pb.h"

namespace skinframe::client {

enum ExitCode : int {
  kExitSuccess = 0,      // all printers done; the question is answered
  kExitUsage = 2,        // wrong usage, unknown printer, material or option, not built
  kExitInput = 3,        // mesh unreadable, empty, not repairable, out of bounds; does not fit the only tray
  kExitInfeasible = 4,   // the constraints cannot hold
  kExitFailed = 5,       // crash, time-out, out of memory, internal, a file that cannot be written
  kExitCancelled = 6,    // cancelled, Ctrl-C
  kExitUnreachable = 7,  // server unreachable, queue full after retries
  kExitPartial = 8,      // some printers done, others refused or failed
  kExitNotFound = 9,     // unknown job or artifact
};

// Of a job that has ended. A job that has not is no answer: kExitFailed.
ExitCode exit_code(v1::JobState state, v1::Reason reason);
// Of a call that did not work.
ExitCode exit_code(FailureKind kind);

}  // namespace skinframe::client
