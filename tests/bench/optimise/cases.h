// SPDX-License-Identifier: GPL-3.0-or-later
// Which frames are measured.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tests/bench/frames/ellipsoid.h"
#include "worker/run/result.h"

namespace skinframe::bench {

struct FrameChoice {
  std::vector<std::string>
      bodies;  // ellipsoid, hanging-ball: at each size; paper, corpus: at counts of their own
  std::vector<FrameSize> sizes;
  std::filesystem::path models;  // the corpus
};

struct NamedProblem {
  std::string name;
  FrameProblem problem;     // without external loads
  bool fixed_load = false;  // the load is taken as it is, never scaled
};

// Calls `use` with each, in order; a frame that cannot be made is told on stderr and left out. False when
// there was none at all.
bool for_each_frame(const FrameChoice& choice, const std::function<void(const NamedProblem&)>& use);

std::vector<std::string> body_names();

}  // namespace skinframe::bench
