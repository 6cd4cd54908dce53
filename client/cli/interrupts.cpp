// SPDX-License-Identifier: Apache-2.0
#include "client/cli/interrupts.h"

#include <poll.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <array>
#include <cstdio>

namespace skinframe::client {

Interrupts::Interrupts() {
  sigset_t signals;
  ::sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) ::sigaddset(&signals, signal);
  ::pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  signals_ = ::signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK);
  quit_ = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  no_question_ = ::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  thread_ = std::thread([this] { run(); });
}

Interrupts::~Interrupts() {
  ::eventfd_write(quit_, 1);
  thread_.join();
  for (const int fd : {signals_, quit_, no_question_}) ::close(fd);
}

void Interrupts::run() {
  while (true) {
    std::array<pollfd, 2> fds{{{signals_, POLLIN, 0}, {quit_, POLLIN, 0}}};
    ::poll(fds.data(), fds.size(), -1);
    if (fds[1].revents != 0) return;
    signalfd_siginfo info{};
    if (::read(signals_, &info, sizeof info) != sizeof info) continue;
    const std::lock_guard lock(mutex_);
    if (handler_) {
      handler_(static_cast<int>(info.ssi_signo));
    } else {
      stop_.request_stop();
    }
  }
}

Answer Interrupts::ask(const std::string& question) {
  std::fputs(question.c_str(), stderr);
  std::fflush(stderr);
  std::array<pollfd, 3> fds{{{signals_, POLLIN, 0}, {STDIN_FILENO, POLLIN, 0}, {no_question_, POLLIN, 0}}};
  ::poll(fds.data(), fds.size(), -1);
  if (fds[2].revents != 0) return Answer::kNo;
  if (fds[0].revents != 0) {
    signalfd_siginfo info{};
    if (::read(signals_, &info, sizeof info) == sizeof info) return Answer::kSignal;
  }
  std::array<char, 256> line{};
  const ssize_t got = ::read(STDIN_FILENO, line.data(), line.size());
  if (got <= 0) return Answer::kSignal;  // nobody is there to answer
  return line[0] == 'y' || line[0] == 'Y' ? Answer::kYes : Answer::kNo;
}

Interrupts::Handling::Handling(Interrupts& interrupts, Handler handler) : interrupts_(interrupts) {
  eventfd_t taken = 0;
  ::eventfd_read(interrupts_.no_question_, &taken);
  const std::lock_guard lock(interrupts_.mutex_);
  interrupts_.handler_ = std::move(handler);
}

Interrupts::Handling::~Handling() {
  ::eventfd_write(interrupts_.no_question_, 1);
  const std::lock_guard lock(interrupts_.mutex_);
  interrupts_.handler_ = nullptr;
}

}  // namespace skinframe::client
