// SPDX-License-Identifier: Apache-2.0
// From a job's first event to its files: what `run` and `submit --watch` do after the submission.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "client/call/connect.h"
#include "client/cli/exit_code.h"
#include "client/cli/interrupts.h"

namespace skinframe::client {

// "skinframe: ..." on stderr; the exit code of the failure.
ExitCode tell(const Failure& failure);

struct FollowOptions {
  std::filesystem::path out;  // empty: results are not downloaded
  bool json = false;          // the final job on stdout instead of the table
  // Why the server cannot be reached any more, where the caller knows: told in place of what the calls say.
  std::function<std::optional<Failure>()> cause = {};
};

// Shows the progress, downloads, reports, and returns the exit code of the job's end. On Ctrl-C the job is
// cancelled, on a terminal after one question; a further signal leaves without waiting for the end.
// `connection` stops with interrupts.stop_source().
ExitCode follow_job(const Connection& connection, Interrupts& interrupts, const std::string& job_id,
                    const FollowOptions& options);

}  // namespace skinframe::client
