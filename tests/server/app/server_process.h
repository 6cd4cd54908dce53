// SPDX-License-Identifier: Apache-2.0
// The real skinframe-server as a child process, to be killed and started again over the same data.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace skinframe::server {

class ServerProcess {
 public:
  explicit ServerProcess(std::filesystem::path folder) : folder_(std::move(folder)) {}
  ~ServerProcess();  // kills what still runs
  ServerProcess(const ServerProcess&) = delete;
  ServerProcess& operator=(const ServerProcess&) = delete;

  // Starts it and waits until it listens; its address. Empty: it ended, or did not listen within 30 s.
  std::string start(const std::vector<std::string>& extra_arguments = {});
  int stop(int signal);  // sends the signal and waits: the exit code, or minus the signal that ended it

  // Runs it to its end, which must come by itself: the exit code and what it wrote to stderr.
  static std::pair<int, std::string> run(const std::vector<std::string>& arguments,
                                         const std::filesystem::path& folder);

 private:
  std::filesystem::path folder_;
  pid_t pid_ = -1;
};

}  // namespace skinframe::server
