// SPDX-License-Identifier: GPL-3.0-or-later
// `skinframe solve-frame PROBLEM.json --out RESULT.json`: the optimiser alone, on a given frame.
#pragma once

#include <filesystem>

#include "worker/run/run_context.h"

namespace skinframe {

// The exit code: 0 solved, 3 bad problem file, 4 infeasible (the result is written all the same), 5 internal,
// out of memory or not writable, 6 cancelled. Errors go to stderr; stdout gets a summary, as one line of JSON
// (result_summary.h) when json_summary. verbose: a line on stderr for each iteration of the interior point.
struct SolveFrameOptions {
  bool json_summary = false;
  bool verbose = false;
};
int solve_frame_main(const std::filesystem::path& problem, const std::filesystem::path& out,
                     const SolveFrameOptions& options, RunContext& context);
// The same with progress on stderr, stopped by SIGINT and SIGTERM: before any other thread of ours starts.
int solve_frame_main(const std::filesystem::path& problem, const std::filesystem::path& out,
                     const SolveFrameOptions& options);

}  // namespace skinframe
