// SPDX-License-Identifier: GPL-3.0-or-later
// Brings the job's newest checkpoint to the server, on a thread of its own: a slow upload holds neither the
// job nor its heartbeats up. One at a time; of those that come meanwhile only the newest goes. What fails is
// let go: the next one will do, and without one the next attempt begins at its beginning.
#pragma once

#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "skinframe/v1/worker.pb.h"
#include "worker/agent/job_runner.h"

namespace skinframe::agent {

class CheckpointSender {
 public:
  CheckpointSender(ServerStubs stubs, const v1::Assignment& assignment, std::filesystem::path job_folder);
  ~CheckpointSender();  // an upload under way is given up
  CheckpointSender(const CheckpointSender&) = delete;
  CheckpointSender& operator=(const CheckpointSender&) = delete;

  // JOB_FOLDER/checkpoint is new, with this stage finished.
  void ready(std::string stage);

 private:
  void run(const std::stop_token& stop);
  void send(const std::string& stage, const std::stop_token& stop);

  ServerStubs stubs_;
  const std::string job_id_;
  const std::int64_t fencing_token_;
  const std::filesystem::path folder_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::optional<std::string> waiting_;  // the stage of the newest
  std::jthread thread_;                 // last: it uses all of the above
};

}  // namespace skinframe::agent
