// SPDX-License-Identifier: GPL-3.0-or-later
// SIGTERM and SIGINT as something to wait for. By a handler, not by blocking alone: libraries (OpenBLAS)
// start threads when they are loaded, which have nothing blocked, and a signal that reached one of them would
// end the process in the midst of its work. Our threads block the two, and so do children until they are at
// exec.
#pragma once

#include <signal.h>

#include <chrono>
#include <stop_token>
#include <thread>

namespace skinframe {

// One at a time in a process; make it before any other thread of ours starts. When it goes, further signals
// are ignored: the process is ending already.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  // Whether one came, waiting up to that time. For one thread, which from then on takes the signals.
  bool came_within(std::chrono::milliseconds time) const;

 private:
  int event_;  // an eventfd
  sigset_t signals_{};
};

// A stop token that the first of the two signals requests; what it is given to ends in its own time.
class StopOnSignal {
 public:
  StopOnSignal();
  std::stop_token token() const { return stop_.get_token(); }

 private:
  StopSignals signals_;
  std::stop_source stop_;
  std::jthread listener_;  // last: it uses the others
};

}  // namespace skinframe
