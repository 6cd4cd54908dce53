// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/run/stop_signals.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdint>

#include "worker/run/result.h"

namespace skinframe {
namespace {

std::atomic<int> stop_event{-1};  // for the handler

extern "C" void note_stop_signal(int) {
  const int before = errno;
  const std::uint64_t one = 1;
  const ssize_t ignored = ::write(stop_event, &one, sizeof one);  // full: it has been told already
  static_cast<void>(ignored);
  errno = before;
}

}  // namespace

StopSignals::StopSignals() : event_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  SKINFRAME_CHECK(event_ >= 0);
  stop_event = event_;
  ::sigemptyset(&signals_);
  struct sigaction action {};
  action.sa_handler = note_stop_signal;
  action.sa_flags = SA_RESTART;
  for (const int signal : {SIGTERM, SIGINT}) {
    ::sigaddset(&signals_, signal);
    ::sigaction(signal, &action, nullptr);
  }
  ::pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
}

StopSignals::~StopSignals() {
  for (const int signal : {SIGTERM, SIGINT}) ::signal(signal, SIG_IGN);
  stop_event = -1;
  ::close(event_);
}

bool StopSignals::came_within(std::chrono::milliseconds time) const {
  ::pthread_sigmask(SIG_UNBLOCK, &signals_, nullptr);
  pollfd event{event_, POLLIN, 0};
  std::uint64_t count = 0;
  return ::poll(&event, 1, static_cast<int>(time.count())) > 0 &&
         ::read(event_, &count, sizeof count) == sizeof count;
}

StopOnSignal::StopOnSignal()
    : listener_([this](const std::stop_token& done) {
        while (!done.stop_requested())
          if (signals_.came_within(std::chrono::milliseconds(50))) stop_.request_stop();
      }) {}

}  // namespace skinframe
