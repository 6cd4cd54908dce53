// SPDX-License-Identifier: Apache-2.0
// A child of `skinframe run`: in a process group of its own, so that Ctrl-C on the terminal reaches only us,
// and ended by the system when the thread that started it ends.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "client/call/result.h"

namespace skinframe::client {

class BackgroundProcess {
 public:
  // words[0] is the program. stdout and stderr are appended to the log.
  static Result<BackgroundProcess> start(const std::vector<std::string>& words,
                                         const std::filesystem::path& log);
  BackgroundProcess(BackgroundProcess&& other) noexcept;
  BackgroundProcess& operator=(BackgroundProcess&& other) noexcept;
  ~BackgroundProcess();  // kills

  int exit_fd() const { return exit_fd_; }  // readable once it has ended
  // SIGTERM, then SIGKILL when it has not ended by then.
  void stop(std::chrono::milliseconds grace);

 private:
  BackgroundProcess(pid_t pid, int exit_fd) : pid_(pid), exit_fd_(exit_fd) {}
  void reap();

  pid_t pid_ = -1;
  int exit_fd_ = -1;
};

}  // namespace skinframe::client
