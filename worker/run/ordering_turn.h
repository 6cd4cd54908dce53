// SPDX-License-Identifier: GPL-3.0-or-later
// METIS, which CHOLMOD asks for orderings too, draws from the C library's rand(), and that is one for the
// whole process: two orderings at once get each other's numbers, and the sums that follow differ in their
// last digits from run to run. Whoever orders a matrix takes a turn for as long as that lasts.
#pragma once

#include <mutex>

namespace skinframe {

class OrderingTurn {
 public:
  OrderingTurn() : lock_(mutex()) {}

 private:
  static std::mutex& mutex() {
    static std::mutex one;
    return one;
  }
  std::scoped_lock<std::mutex> lock_;
};

}  // namespace skinframe
