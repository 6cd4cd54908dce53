// SPDX-License-Identifier: Apache-2.0
#include "client/cli/background_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <climits>
#include <cstring>
#include <string_view>
#include <utility>

namespace skinframe::client {
namespace {

// Between fork and exec: async-signal-safe calls only, since other threads (gRPC's) may hold locks.
[[noreturn]] void become(char* const* arguments, char* const* environment, pid_t parent, int null_in,
                         int log) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(127);
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  if (::dup2(null_in, 0) < 0 || ::dup2(log, 1) < 0 || ::dup2(log, 2) < 0) ::_exit(127);
  ::close_range(3, UINT_MAX, CLOSE_RANGE_CLOEXEC);
  ::execve(arguments[0], arguments, environment);
  constexpr char kWhy[] = "cannot run the program\n";
  const ssize_t ignored = ::write(2, kWhy, sizeof kWhy - 1);
  static_cast<void>(ignored);
  ::_exit(127);
}

// What configures the farm's servers and workers is not meant for those that are started here.
std::vector<char*> environment_without_options() {
  std::vector<char*> kept;
  for (char** entry = ::environ; *entry != nullptr; ++entry) {
    const std::string_view words(*entry);
    if (!words.starts_with("SKINFRAME_SERVER") && !words.starts_with("SKINFRAME_WORKER_"))
      kept.push_back(*entry);
  }
  kept.push_back(nullptr);
  return kept;
}

}  // namespace

Result<BackgroundProcess> BackgroundProcess::start(const std::vector<std::string>& words,
                                                   const std::filesystem::path& log) {
  const auto failed = [&](const std::string& what) {
    return Failure{FailureKind::kLocal, fmt::format("{}: {}: {}", words[0], what, std::strerror(errno))};
  };
  const int log_fd = ::open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  if (log_fd < 0) return failed(log.string());
  const int null_in = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const std::vector<char*> environment = environment_without_options();
  const pid_t parent = ::getpid();
  const pid_t pid = ::_Fork();
  if (pid == 0) become(arguments.data(), environment.data(), parent, null_in, log_fd);
  ::close(log_fd);
  ::close(null_in);
  if (pid < 0) return failed("no new process");
  return BackgroundProcess(pid, static_cast<int>(::syscall(SYS_pidfd_open, pid, 0)));
}

BackgroundProcess::BackgroundProcess(BackgroundProcess&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)), exit_fd_(std::exchange(other.exit_fd_, -1)) {}

BackgroundProcess& BackgroundProcess::operator=(BackgroundProcess&& other) noexcept {
  std::swap(pid_, other.pid_);
  std::swap(exit_fd_, other.exit_fd_);
  return *this;
}

BackgroundProcess::~BackgroundProcess() { stop(std::chrono::milliseconds(0)); }

void BackgroundProcess::stop(std::chrono::milliseconds grace) {
  if (pid_ <= 0) return;
  if (grace.count() > 0) {
    ::kill(pid_, SIGTERM);
    pollfd ended{exit_fd_, POLLIN, 0};
    while (::poll(&ended, 1, static_cast<int>(grace.count())) < 0 && errno == EINTR) {
    }
  }
  ::kill(pid_, SIGKILL);  // nothing to a process that has ended and is not reaped yet
  reap();
}

void BackgroundProcess::reap() {
  int status = 0;
  while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  if (exit_fd_ >= 0) ::close(std::exchange(exit_fd_, -1));
}

}  // namespace skinframe::client
