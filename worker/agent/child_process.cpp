// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/agent/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <climits>
#include <cstring>

namespace skinframe::agent {
namespace {

struct Pipe {
  Descriptor read;
  Descriptor write;
};

Result<Pipe> make_pipe() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return io_error(fmt::format("no pipe: {}", std::strerror(errno)));
  return Pipe{Descriptor(ends[0]), Descriptor(ends[1])};
}

// What the child does between fork and exec. The address space is a copy in which other threads' locks may be
// held for ever, so only async-signal-safe calls, no allocation. Never returns.
struct ChildSide {
  const char* program;
  char* const* arguments;
  pid_t parent;
  int null_in, out, err, failure;
  bool limited;
  rlimit address_space;

  [[noreturn]] void fail() const {
    const int reason = errno;
    const ssize_t ignored =
        ::write(failure, &reason, sizeof reason);  // the reader sees a short read otherwise
    static_cast<void>(ignored);
    ::_exit(127);
  }

  [[noreturn]] void become_program() const {
    ::setpgid(0, 0);
    if (::prctl(PR_SET_PDEATHSIG, SIGKILL) != 0) fail();
    if (::getppid() != parent)
      ::_exit(127);  // the agent died before the line above: nobody is left to work for
    for (int signal = 1; signal < NSIG; ++signal) ::signal(signal, SIG_DFL);
    sigset_t none;
    ::sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
    if (::dup2(null_in, 0) < 0 || ::dup2(out, 1) < 0 || ::dup2(err, 2) < 0) fail();
    ::close_range(3, UINT_MAX, CLOSE_RANGE_CLOEXEC);  // whatever a library opened without close-on-exec
    if (limited && ::setrlimit(RLIMIT_AS, &address_space) != 0) fail();
    ::execv(program, arguments);
    fail();
  }
};

}  // namespace

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  if (this != &other) {
    if (fd_ >= 0) ::close(fd_);
    fd_ = other.release();
  }
  return *this;
}

Descriptor::~Descriptor() {
  if (fd_ >= 0) ::close(fd_);
}

int Descriptor::release() { return std::exchange(fd_, -1); }

std::string signal_name(int signal) {
  const char* name = ::sigabbrev_np(signal);
  return name != nullptr ? fmt::format("SIG{}", name) : fmt::format("signal {}", signal);
}

Result<ChildProcess> ChildProcess::start(const ChildCommand& command) {
  SKINFRAME_CHECK(!command.arguments.empty());
  auto out = make_pipe();
  if (!out) return out.error();
  auto err = make_pipe();
  if (!err) return err.error();
  auto failure = make_pipe();
  if (!failure) return failure.error();
  const Descriptor null_in(::open("/dev/null", O_RDONLY | O_CLOEXEC));
  if (null_in.get() < 0) return io_error(fmt::format("/dev/null: {}", std::strerror(errno)));

  std::vector<char*> arguments;
  for (const std::string& word : command.arguments) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const rlim_t limit = command.address_space_bytes.value_or(0);
  const ChildSide child_side{command.program.c_str(),
                             arguments.data(),
                             ::getpid(),
                             null_in.get(),
                             out->write.get(),
                             err->write.get(),
                             failure->write.get(),
                             command.address_space_bytes.has_value(),
                             rlimit{limit, limit}};

  const pid_t pid = ::_Fork();  // no atfork handlers: they are not async-signal-safe
  if (pid == 0) child_side.become_program();
  if (pid < 0) return io_error(fmt::format("no new process: {}", std::strerror(errno)));

  ChildProcess child;
  child.pid_ = pid;
  failure.value().write = Descriptor();
  int reason = 0;
  ssize_t got = 0;
  do {
    got = ::read(failure->read.get(), &reason, sizeof reason);  // ends with 0 bytes when exec closed the pipe
  } while (got < 0 && errno == EINTR);
  if (got == sizeof reason) {
    return io_error(fmt::format("cannot run {}: {}", command.program, std::strerror(reason)));
  }
  child.exit_ = Descriptor(static_cast<int>(::syscall(SYS_pidfd_open, pid, 0)));
  if (child.exit_.get() < 0) return io_error(fmt::format("no pidfd: {}", std::strerror(errno)));
  child.stdout_ = std::move(out.value().read);
  child.stderr_ = std::move(err.value().read);
  for (const int fd : {child.stdout_.get(), child.stderr_.get()}) ::fcntl(fd, F_SETFL, O_NONBLOCK);
  return child;
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)),
      stdout_(std::move(other.stdout_)),
      stderr_(std::move(other.stderr_)),
      exit_(std::move(other.exit_)) {}

ChildProcess::~ChildProcess() {
  if (pid_ <= 0) return;
  signal_group(SIGKILL);
  wait();
}

void ChildProcess::signal_group(int signal) const {
  if (pid_ <= 0) return;
  // The group does not exist for the moment between fork and setpgid: then the child itself.
  if (::kill(-pid_, signal) != 0) ::kill(pid_, signal);
}

ChildExit ChildProcess::wait() {
  // Wait without reaping first: until it is reaped, the process's and the group's number cannot be another's.
  siginfo_t info{};
  while (::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOWAIT) != 0 && errno == EINTR) {
  }
  ::kill(-pid_, SIGKILL);
  int status = 0;
  while (::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  pid_ = -1;
  if (WIFSIGNALED(status)) return {0, WTERMSIG(status)};
  return {WEXITSTATUS(status), 0};
}

}  // namespace skinframe::agent
