// SPDX-License-Identifier: GPL-3.0-or-later
// Where Algorithm 1 stands after its sizing and after each of its stages: all that the rest of it depends on,
// and what it has to say in the end. From here it goes on as if it had never been broken off.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "worker/optimize/design.h"
#include "worker/optimize/optimize_frame.h"
#include "worker/optimize/session.h"

namespace skinframe {

// Within TopOpt and GeoOpt in turn.
struct OuterLoop {
  int round = 0;
  bool after_topology = false;  // of this round; volume_before and struts_before are then of its beginning
  bool settled = false;         // geometry's last word
  bool ended = false;
  double volume_before_mm3 = 0;
  int struts_before = 0;
};

struct AlgorithmState {
  OuterLoop loop;
  Design design;
  SessionState session;
  OptimizeResult so_far;  // stage records, bounds and their proofs, outer iterations, seconds; no more
};

// Tells calls of optimize_frame apart by their problem and options.
std::string algorithm_key(const FrameProblem& problem, const OptimizeOptions& options);

std::string to_bytes(AlgorithmState& state);

// Nothing: the bytes make no sense for a problem of so many nodes and struts.
std::optional<AlgorithmState> algorithm_state(std::string_view bytes, const FrameProblem& problem);

}  // namespace skinframe
