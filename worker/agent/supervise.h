// SPDX-License-Identifier: GPL-3.0-or-later
// Stays with a child until it has ended: hands on its lines, and ends it when told to.
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <stop_token>
#include <string_view>

#include "worker/agent/child_process.h"

namespace skinframe::agent {

inline constexpr std::size_t kMaxEventLineBytes = 64 * 1024;  // longer event lines are dropped
inline constexpr std::size_t kMaxLogLineBytes = 4 * 1024;     // longer log lines are cut

struct SuperviseOptions {
  std::stop_token stop;  // asks for the child's end
  // From SIGTERM to SIGKILL. Nothing of a job that was told to stop is kept but a result that is whole
  // already, so what it leaves undone costs nothing, and a cancellation is over within a second.
  std::chrono::milliseconds kill_after = std::chrono::milliseconds(300);
  std::function<void(std::string_view)> on_stdout_line;
  std::function<void(std::string_view)> on_stderr_line;
};

struct Supervised {
  ChildExit exit;
  std::size_t dropped_lines = 0;  // of stdout, over the bound
};

// Every line that the child wrote before its end is handed on before this returns.
Supervised supervise(ChildProcess& child, const SuperviseOptions& options);

}  // namespace skinframe::agent
