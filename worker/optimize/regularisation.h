// SPDX-License-Identifier: GPL-3.0-or-later
// Which regularisation to try until the inertia is right: none first, then growing, starting near what was
// needed last time (Waechter and Biegler 2006, algorithm IC).
#pragma once

#include <algorithm>
#include <optional>

#include "worker/optimize/kkt_system.h"

namespace skinframe {

class InertiaCorrection {
 public:
  // The first to try at a new iterate.
  Regularisation first() {
    current_ = {};
    return current_;
  }
  // The next to try; none when even the largest failed.
  std::optional<Regularisation> next() {
    current_.dual = kDual;
    if (current_.primal == 0)
      current_.primal = last_ == 0 ? kFirst : std::max(kSmallest, last_ / kDecrease);
    else
      current_.primal *= last_ == 0 ? kFastIncrease : kIncrease;
    if (current_.primal > kLargest) return std::nullopt;
    return current_;
  }
  // The current one worked.
  void accept() {
    if (current_.primal > 0) last_ = current_.primal;
  }
  // The step it gave was no good: start stronger next time.
  void distrust() { last_ = std::max(kFirst, kIncrease * last_); }

 private:
  static constexpr double kFirst = 1e-4, kSmallest = 1e-12, kLargest = 1e12;
  static constexpr double kDecrease = 3, kIncrease = 8, kFastIncrease = 100, kDual = 1e-8;
  Regularisation current_;
  double last_ = 0;
};

}  // namespace skinframe
