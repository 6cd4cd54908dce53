// SPDX-License-Identifier: GPL-3.0-or-later
// The barrier parameter falls when its own problem is solved well enough: error(mu) <= kSolvedWell mu
// (Fiacco and McCormick's monotone rule, superlinear at the end; Waechter and Biegler 2006, eq. 7).
#pragma once

#include <algorithm>
#include <cmath>

namespace skinframe {

class BarrierUpdate {
 public:
  BarrierUpdate(double initial, double smallest) : value_(initial), smallest_(smallest) {}
  double value() const { return value_; }
  bool solved_well(double error) const { return error <= kSolvedWell * value_ && value_ > smallest_; }
  void decrease() {
    value_ = std::max(smallest_, std::min(kLinear * value_, std::pow(value_, kSuperlinear)));
  }
  // How close a step may come to the boundary: it leaves the share 1 - this of each slack.
  double fraction_to_boundary() const { return std::max(kLeastFraction, 1 - value_); }

 private:
  static constexpr double kSolvedWell = 30, kLinear = 0.2, kSuperlinear = 1.5, kLeastFraction = 0.99;
  double value_, smallest_;
};

}  // namespace skinframe
