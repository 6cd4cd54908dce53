// SPDX-License-Identifier: GPL-3.0-or-later
// Loads to measure with, on the skin nodes about the highest one. Gravity acts in every case.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "worker/mechanics/frame_problem.h"

namespace skinframe::bench {

enum class LoadKind {
  kSelf,   // self weight alone
  kSide,   // one case: 20 N sideways, along x or y, whichever asks for more
  kThree,  // three cases: 20 N along y, along x, and down
  kTop5,   // 5 N down: the paper's hanging ball
};

std::optional<LoadKind> load_kind(const std::string& name);  // "self", "side", "three", "top5"
std::vector<std::string> load_names();

struct LoadedProblem {
  FrameProblem problem;
  double force_n = 0;  // of each case; 0 for self weight
};

// The problem with these load cases instead of its own. `demanding`: the force of kSide and kThree is doubled
// until struts at their lower bounds exceed a limit clearly (kDemanding), since a frame that holds at its
// lower bounds measures nothing but the presolve: large frames have so many struts that 20 N is no load for
// them.
inline constexpr double kDemanding = 1.5;  // demand over limit
LoadedProblem with_loads(FrameProblem problem, LoadKind kind, bool demanding);

}  // namespace skinframe::bench
