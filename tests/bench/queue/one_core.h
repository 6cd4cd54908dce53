// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sched.h>

namespace skinframe::bench {

// While it lives, the calling thread, and what threads and processes it starts, share one core. A call that
// is handed from thread to thread otherwise takes once or twice as long as the scheduler puts the two side by
// side or apart, for the whole of a run: more than what is compared. Throws std::runtime_error where the
// system refuses.
class OneCore {
 public:
  OneCore();
  ~OneCore();
  OneCore(const OneCore&) = delete;
  OneCore& operator=(const OneCore&) = delete;

 private:
  cpu_set_t before_;
};

}  // namespace skinframe::bench
