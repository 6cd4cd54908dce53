// SPDX-License-Identifier: GPL-3.0-or-later
// A frame problem as a job: the optimiser alone, on the frame that the file gives.
//
//   out_dir/result.json   what `solve-frame` writes (worker/problem/result_file.h): a problem file of its own
//   out_dir/report.json   {"job_id", "version", "frame": {"problem", "file": "result.json", "reason",
//   "detail",
//                         and the figures of worker/problem/result_summary.h}}
//
// Both are written with INFEASIBLE too: of the best frame that was found.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "worker/job/event_stream.h"
#include "worker/job/read_job.h"
#include "worker/run/run_context.h"

namespace skinframe {

// outcome.json of a job that ended without a result.
nlohmann::json failed_outcome(Reason reason, const std::string& detail);

// outcome.json. file.frame_problem is there.
nlohmann::json run_frame_job(const JobFile& file, const std::filesystem::path& out_dir, EventStream& events,
                             Checkpoints* checkpoints, const RunContext& shared);

}  // namespace skinframe
