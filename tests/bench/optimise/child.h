// SPDX-License-Identifier: GPL-3.0-or-later
// A program run to its end, or to a time limit: each row of the table is a process of its own, so that memory
// and crashes are its own too.
#pragma once

#include <string>
#include <vector>

namespace skinframe::bench {

struct ChildEnd {
  int exit_code = -1;  // 128 + signal for one that was killed
  bool timed_out = false;
  std::string out;
};

// Standard error goes through. BLAS gets one thread, in every program alike.
ChildEnd run_child(const std::vector<std::string>& command, double max_seconds);

// The largest resident memory of this process since it began, in MB (VmHWM).
double peak_memory_mb();

}  // namespace skinframe::bench
