// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/queue/one_core.h"

#include <stdexcept>

namespace skinframe::bench {

OneCore::OneCore() {
  const int here = ::sched_getcpu();
  cpu_set_t one;
  CPU_ZERO(&one);
  if (here >= 0) CPU_SET(static_cast<std::size_t>(here), &one);
  if (here < 0 || ::sched_getaffinity(0, sizeof before_, &before_) != 0 ||
      ::sched_setaffinity(0, sizeof one, &one) != 0) {
    throw std::runtime_error("the system does not let this bench stay on one core");
  }
}

OneCore::~OneCore() { ::sched_setaffinity(0, sizeof before_, &before_); }

}  // namespace skinframe::bench
