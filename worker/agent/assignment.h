// SPDX-License-Identifier: GPL-3.0-or-later
// From the server's words to the job process's: an Assignment becomes the text of job.json
// (worker/job/README.md).
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "skinframe/v1/worker.pb.h"
#include "worker/run/result.h"

namespace skinframe::agent {

// Defaults that the API leaves to "unspecified" are spelled out; "absent" options become null.
// kUnsupported: the input is neither a mesh nor a frame problem. kInternal: the server broke the protocol
// (profiles do not match the printers, an enum value that this worker does not know).
// warm_start_files: what choose_warm_start_files chose, by the folder that it stood in, where it lies now.
Result<std::string> job_request_json(const v1::Assignment& assignment,
                                     const std::filesystem::path& input_path,
                                     const std::map<std::string, std::filesystem::path>& warm_start_files,
                                     int threads);

// The artifact that the job works on.
const std::string& input_sha256(const v1::JobSpec& spec);

// Of the earlier job's files those that a job can start from: PRINTER/initial-frame.json, by PRINTER; at most
// 16.
std::map<std::string, v1::ResultFile> choose_warm_start_files(const v1::Assignment& assignment);

}  // namespace skinframe::agent
