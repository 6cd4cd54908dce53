// SPDX-License-Identifier: GPL-3.0-or-later
// The methods that run in this program; the oracle (Ipopt) is another one.
#pragma once

#include <string>
#include <vector>

#include "tests/bench/optimise/row.h"
#include "worker/mechanics/frame_problem.h"
#include "worker/run/result.h"

namespace skinframe::bench {

// size: SizeOpt of ours. tight, paper: Algorithm 1 in that order. uniform: one radius for all. greedy:
// cleaning by a threshold on the radius. mma: nested MMA; where NLopt was there when this was built.
std::vector<std::string> method_names();
bool has_nlopt();

struct MethodLimits {
  double max_seconds = 600;  // asked for; a method looks at it when it can
  int threads = 1;
};

// Fills what the method knows; frame, load and memory are the caller's.
Result<Row> run_method(const std::string& method, const FrameProblem& problem, const MethodLimits& limits);

}  // namespace skinframe::bench
