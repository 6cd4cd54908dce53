// SPDX-License-Identifier: Apache-2.0
// The job's options on the command line: each is one field of the request.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "client/call/result.h"
#include "skinframe/v1/job.pb.h"

namespace CLI {
class App;
}

namespace skinframe::client {

struct JobArguments {
  std::string mesh;  // or a frame problem
  std::vector<std::string> printers;
  std::vector<std::string> materials;  // none, one for all printers, or one for each
  std::vector<std::string> loads;
  std::vector<std::string> labels;
  std::optional<double> size_mm;
  std::string up, balance, smooth, orient, order, verify;  // empty: the server's default
  std::optional<std::int32_t> skin_nodes, internal_nodes;
  std::optional<double> voxel_mm, displacement_limit_mm;
  bool no_optimize = false;
  std::optional<std::uint64_t> seed;
  std::int32_t priority = 0;
  std::string deadline;
  std::string request_id;
  std::string warm_start;  // an earlier job's id
  bool validate_only = false;
  bool no_reuse = false;
};

// Adds FILE and all options of a job to a verb.
void add_job_options(CLI::App& verb, JobArguments& arguments);

// All of the request but the file's hash. kUsage names the option.
Result<v1::SubmitJobRequest> to_request(const JobArguments& arguments);

}  // namespace skinframe::client
