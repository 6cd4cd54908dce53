// SPDX-License-Identifier: GPL-3.0-or-later
// Where jobs work: ROOT/agent-RANDOM/job-TOKEN. Several agents may share a root: each holds a lock in its own
// folder, and a folder whose lock nobody holds is the leaving of an agent that was killed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "worker/agent/child_process.h"
#include "worker/run/result.h"

namespace skinframe::agent {

class AgentFolder {
 public:
  // Makes the folder, after removing stale ones beside it. kIo with the path.
  static Result<AgentFolder> create(const std::filesystem::path& root, const std::string& instance_id);
  AgentFolder(AgentFolder&&) noexcept = default;
  AgentFolder& operator=(AgentFolder&&) = delete;
  ~AgentFolder();
  const std::filesystem::path& path() const { return path_; }

 private:
  AgentFolder() = default;
  std::filesystem::path path_;
  Descriptor lock_;
};

// WORKDIR of one attempt; gone with its object.
class JobFolder {
 public:
  static Result<JobFolder> create(const std::filesystem::path& agent_folder, const std::string& job_id,
                                  std::int64_t fencing_token);
  JobFolder(JobFolder&& other) noexcept : path_(std::move(other.path_)), job_id_(std::move(other.job_id_)) {
    other.path_.clear();
  }
  JobFolder& operator=(JobFolder&&) = delete;
  ~JobFolder();
  const std::filesystem::path& path() const { return path_; }

 private:
  JobFolder(std::filesystem::path path, std::string job_id)
      : path_(std::move(path)), job_id_(std::move(job_id)) {}
  std::filesystem::path path_;
  std::string job_id_;  // for the log
};

// The regular files below out, relative, sorted; none when out is not there. Links are not followed:
// kInternal names one, as it does a count over 10 000.
Result<std::vector<std::filesystem::path>> list_result_files(const std::filesystem::path& out);

}  // namespace skinframe::agent
