// SPDX-License-Identifier: Apache-2.0
// The server and one worker of `skinframe run`, as processes beside the client: the same programs that a farm
// runs.
//
// A worker that dies is started again, a few times: the server hands its job on. A server that dies ends the
// run.
#pragma once

#include <filesystem>
#include <future>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "client/call/result.h"

namespace skinframe::client {

class EmbeddedFarm {
 public:
  // data empty: in the temporary folder, and gone with it. profiles empty: the built-in ones. `on_failure` is
  // asked to stop when the farm cannot go on.
  EmbeddedFarm(std::filesystem::path data, std::filesystem::path profiles, std::stop_source stop);
  ~EmbeddedFarm();  // stops both, removes the temporary folder (the logs stay after keep_logs)
  EmbeddedFarm(const EmbeddedFarm&) = delete;
  EmbeddedFarm& operator=(const EmbeddedFarm&) = delete;

  // Waits until the server listens. Its address, or kLocal: a program is missing or the server did not start.
  Result<std::string> address();

  std::optional<Failure> failure() const;  // why the farm could not go on
  std::filesystem::path keep_logs();       // the folder of the logs, which now stays

 private:
  void run(std::promise<Result<std::string>> started);
  Result<std::string> serve(std::promise<Result<std::string>>& started);
  void fail(Failure failure);

  std::filesystem::path folder_, data_, profiles_;
  std::stop_source stop_;
  std::future<Result<std::string>> started_;
  mutable std::mutex mutex_;
  std::optional<Failure> failure_;  // guarded by mutex_
  bool keep_logs_ = false;
  int quit_ = -1;  // eventfd
  std::thread thread_;
};

}  // namespace skinframe::client
