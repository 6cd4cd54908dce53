// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/agent/supervise.h"

#include <poll.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <optional>

#include "worker/agent/line_splitter.h"

namespace skinframe::agent {
namespace {

using SteadyClock = std::chrono::steady_clock;

// Reads at a go, so that a child that floods one stream cannot keep us from the rest of the loop; after its
// end there is at most one full pipe left.
constexpr int kReadsAtAGo = 16;
constexpr int kReadsAfterEnd = 1024;

// Reads what is there. False at the end of the stream.
bool drain(int fd, LineSplitter& lines, int reads = kReadsAtAGo) {
  std::array<char, 16 * 1024> buffer;
  while (reads-- > 0) {
    const ssize_t got = ::read(fd, buffer.data(), buffer.size());
    if (got > 0) {
      lines.feed({buffer.data(), static_cast<std::size_t>(got)});
      if (static_cast<std::size_t>(got) < buffer.size()) return true;
    } else if (got < 0 && errno == EINTR) {
      continue;
    } else {
      return got < 0 && errno == EAGAIN;
    }
  }
  return true;
}

int poll_timeout_ms(std::optional<SteadyClock::time_point> kill_time) {
  if (!kill_time) return -1;
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(*kill_time - SteadyClock::now());
  return static_cast<int>(std::max<std::int64_t>(0, left.count()));
}

}  // namespace

Supervised supervise(ChildProcess& child, const SuperviseOptions& options) {
  LineSplitter out(kMaxEventLineBytes, true, options.on_stdout_line);
  LineSplitter err(kMaxLogLineBytes, false, options.on_stderr_line);
  const Descriptor stop_event(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  SKINFRAME_CHECK(stop_event.get() >= 0);
  const std::stop_callback wake(options.stop, [&] { ::eventfd_write(stop_event.get(), 1); });

  std::array<pollfd, 4> fds{{{child.exit_fd(), POLLIN, 0},
                             {stop_event.get(), POLLIN, 0},
                             {child.stdout_fd(), POLLIN, 0},
                             {child.stderr_fd(), POLLIN, 0}}};
  std::optional<SteadyClock::time_point> kill_time;
  bool ended = false;
  while (!ended) {
    if (::poll(fds.data(), fds.size(), poll_timeout_ms(kill_time)) < 0 && errno != EINTR) break;
    // A negative descriptor is left out of the next poll: that is how a stream at its end stops waking us.
    if (fds[2].revents != 0 && !drain(child.stdout_fd(), out)) fds[2].fd = -1;
    if (fds[3].revents != 0 && !drain(child.stderr_fd(), err)) fds[3].fd = -1;
    if (fds[1].revents != 0) {
      fds[1].fd = -1;
      child.signal_group(SIGTERM);
      kill_time = SteadyClock::now() + options.kill_after;
    }
    if (kill_time && SteadyClock::now() >= *kill_time) {
      child.signal_group(SIGKILL);
      kill_time.reset();
    }
    ended = fds[0].revents != 0;
  }
  const ChildExit exit = child.wait();
  // What it wrote last may have come between our last read and its end.
  drain(child.stdout_fd(), out, kReadsAfterEnd);
  drain(child.stderr_fd(), err, kReadsAfterEnd);
  out.finish();
  err.finish();
  return {exit, out.long_lines()};
}

}  // namespace skinframe::agent
