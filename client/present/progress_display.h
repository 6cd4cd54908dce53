// SPDX-License-Identifier: Apache-2.0
// A job's progress on stderr: a bar that stays in one line on a terminal; elsewhere a line when the stage
// changes and every two seconds, for each printer. States and printers' ends are always told. May be used
// from several threads.
#pragma once

#include <chrono>
#include <cstdio>
#include <map>
#include <mutex>
#include <string>

#include "client/call/clock.h"
#include "skinframe/v1/job.pb.h"

namespace skinframe::client {

// "size       [######..............]  iteration 3  total ..." cut to the width of the terminal.
std::string progress_bar(const v1::JobProgress& progress, std::size_t columns);

class ProgressDisplay {
 public:
  ProgressDisplay(std::FILE* out, bool terminal, Clock& clock)
      : out_(out), terminal_(terminal), clock_(clock) {}
  ~ProgressDisplay() { finish(); }
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  void show(const v1::JobEvent& event);
  void say(const std::string& line);  // a line of its own, above the bar
  void pause(bool paused);            // while a question stands on the terminal
  void finish();                      // the bar goes

 private:
  void line(const std::string& text);
  void clear_bar();

  std::FILE* out_;
  const bool terminal_;
  Clock& clock_;
  std::mutex mutex_;
  bool paused_ = false;
  bool bar_shown_ = false;
  // Printers of one job run side by side: what was told of each.
  struct Told {
    std::string stage, text;
    std::chrono::steady_clock::time_point at{};
  };
  std::map<std::string, Told> told_;
};

}  // namespace skinframe::client
