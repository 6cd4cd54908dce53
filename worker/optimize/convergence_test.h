// SPDX-License-Identifier: GPL-3.0-or-later
// When the interior point stops of its own accord, as a function of the errors so far.
//
// Near the solution the reduced system is so stiff that rounding ends the descent, sooner for programs linear
// in A. When the error has not fallen for kPatience iterations, the best iterate is taken if it is within
// kAcceptableFactor of the tolerance.
#pragma once

#include <optional>

namespace skinframe {

enum class InteriorPointEnd {
  kOptimal,     // error <= tolerance
  kAcceptable,  // best error <= kAcceptableFactor * tolerance, and rounding lets it fall no further
  kGoodEnough,  // the caller said so
  kIterationLimit,
  kStuck,  // neither a step nor a restoration made progress
  kCancelled,
};

inline constexpr double kAcceptableFactor = 100;
inline constexpr int kPatience = 8;

struct ConvergenceState {
  double error = 0;       // scaled KKT error at mu = 0 of the present iterate
  double best_error = 0;  // the least so far
  int iterations_since_best = 0;
};

inline std::optional<InteriorPointEnd> converged(const ConvergenceState& state, double tolerance) {
  if (state.error <= tolerance) return InteriorPointEnd::kOptimal;
  if (state.best_error <= kAcceptableFactor * tolerance && state.iterations_since_best >= kPatience)
    return InteriorPointEnd::kAcceptable;
  return std::nullopt;
}

}  // namespace skinframe
