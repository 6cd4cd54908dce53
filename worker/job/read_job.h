// SPDX-License-Identifier: GPL-3.0-or-later
// job.json, as README.md of this folder gives it, to the request of the pipeline.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "worker/pipeline/request.h"
#include "worker/run/result.h"

namespace skinframe {

struct JobFile {
  JobRequest request;  // of a frame problem: job_id and mesh_name alone
  std::optional<std::filesystem::path> frame_problem;
  int threads = 1;
};

// Errors name the field.
Result<JobFile> parse_job(const nlohmann::json& document);
Result<JobFile> read_job(const std::filesystem::path& path);

}  // namespace skinframe
