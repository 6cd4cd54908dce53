// SPDX-License-Identifier: GPL-3.0-or-later
// From the server's words to the job process's: an Assignment becomes the text of job.json
// (worker/job/README.md).
#pragma once

#include <filesystem>
#include <string>

#include "skinframe/v1/worker.pb.h"
#include "worker/run/result.h"

namespace skinframe::agent {

// Defaults that the API leaves to "unspecified" are spelled out; "absent" options become null.
// kUnsupported: the input is not a mesh, or the job warm-starts. kInternal: the server broke the protocol
// (profiles do not match the printers, an enum value that this worker does not know).
Result<std::string> job_request_json(const v1::Assignment& assignment, const std::filesystem::path& mesh_path,
                                     int threads);

}  // namespace skinframe::agent
