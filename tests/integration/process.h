// SPDX-License-Identifier: Apache-2.0
// A program of ours as a child process: started for real, killed by real signals, waited for with a bound.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace skinframe::integration {

using Seconds = std::chrono::duration<double>;

// Where the build put our programs.
std::filesystem::path binary(const std::string& name);

class Process {
 public:
  // Output goes to files beside each other: OUTPUT.out and OUTPUT.err.
  Process(const std::vector<std::string>& command, const std::filesystem::path& output,
          const std::vector<std::string>& environment = {});
  ~Process();  // kills with SIGKILL what still runs
  Process(Process&& other) noexcept;
  Process(const Process&) = delete;
  Process& operator=(Process&&) = delete;

  pid_t pid() const { return pid_; }
  bool running();
  void signal(int number);
  // Exit code, 128 + signal for one that was killed; -1 when it still runs after the time.
  int wait(Seconds at_most = Seconds(120));
  std::string out() const;
  std::string err() const;

 private:
  pid_t pid_ = -1;
  int exit_code_ = -1;
  std::filesystem::path output_;
};

struct Ran {
  int exit_code;
  std::string out, err;
};
// Runs to its end.
Ran run(const std::vector<std::string>& command, const std::filesystem::path& scratch,
        Seconds at_most = Seconds(300));

// Asks again every 10 ms until it holds or the time is over; whether it held.
bool eventually(const std::function<bool()>& condition, Seconds at_most = Seconds(60));

std::string read_file(const std::filesystem::path& path);

// A folder of its own for a test; removed at the end unless the test failed.
class Scratch {
 public:
  Scratch();
  ~Scratch();
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace skinframe::integration
