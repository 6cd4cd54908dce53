// SPDX-License-Identifier: GPL-3.0-or-later
// One job's process: started by exec, never by fork alone (gRPC has threads), in a process group of its own.
//
// Guarantees
//   - The child inherits no descriptor but its stdin (/dev/null), stdout and stderr (pipes to us).
//   - It dies with the thread that started it (parent-death signal SIGKILL).
//   - Signals are at their defaults and unblocked in it, whatever the agent has blocked.
//   - The destructor kills the whole group and reaps: no child outlives its object.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "worker/run/result.h"

namespace skinframe::agent {

// A file descriptor that closes itself.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(Descriptor&& other) noexcept : fd_(other.release()) {}
  Descriptor& operator=(Descriptor&& other) noexcept;
  ~Descriptor();
  int get() const { return fd_; }
  int release();

 private:
  int fd_ = -1;
};

struct ChildCommand {
  std::string program;                 // its path
  std::vector<std::string> arguments;  // [0] is the name that it goes by
  std::optional<std::uint64_t> address_space_bytes;
};

struct ChildExit {
  int exit_code = 0;  // when signal == 0
  int signal = 0;     // the signal that killed it; 0: it exited by itself
};

// "SIGSEGV"; "signal 99" for one without a name.
std::string signal_name(int signal);

class ChildProcess {
 public:
  // kIo when the program cannot be run, with its path and the system's reason.
  static Result<ChildProcess> start(const ChildCommand& command);
  ChildProcess(ChildProcess&& other) noexcept;
  ChildProcess& operator=(ChildProcess&&) = delete;
  ~ChildProcess();

  int stdout_fd() const { return stdout_.get(); }  // not blocking
  int stderr_fd() const { return stderr_.get(); }  // not blocking
  int exit_fd() const { return exit_.get(); }      // readable once the child has ended
  void signal_group(int signal) const;
  ChildExit wait();  // blocks until the end, then kills what is left of its group

 private:
  ChildProcess() = default;
  pid_t pid_ = -1;
  Descriptor stdout_, stderr_, exit_;
};

}  // namespace skinframe::agent
