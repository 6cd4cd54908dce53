// SPDX-License-Identifier: GPL-3.0-or-later
// The filter line search (Fletcher and Leyffer 2002; Waechter and Biegler 2006, section 2.3): a trial point
// is taken when it improves on every pair (constraint violation, barrier objective) that earlier points have
// left behind.
#pragma once

#include <optional>
#include <vector>

#include "worker/optimize/newton_step.h"

namespace skinframe {

class LineSearch {
 public:
  LineSearch(const FrameProgram& program, const InequalityLayout& layout)
      : program_(program), layout_(layout) {}

  void reset() {
    filter_.clear(), largest_violation_.reset();
  }  // the barrier, and with it the merit, has changed

  // An accepted trial: point and slacks moved, duals as before.
  struct Accepted {
    Iterate iterate;
    double length;
    int halvings;
  };
  std::optional<Accepted> search(const Iterate& iterate, const NewtonStep& step, double barrier);

 private:
  struct Measure {
    double violation, merit;
  };
  Measure measure(const Iterate& iterate, double barrier) const;
  bool acceptable(const Measure& trial) const;

  const FrameProgram& program_;
  const InequalityLayout& layout_;
  std::vector<Measure> filter_;
  std::optional<double> largest_violation_, small_violation_;
};

}  // namespace skinframe
