// SPDX-License-Identifier: Apache-2.0
// Time as the library sees it, so that a test of an hour's backoff takes no time.
#pragma once

#include <chrono>
#include <stop_token>

namespace skinframe::client {

class Clock {
 public:
  virtual ~Clock() = default;
  virtual std::chrono::steady_clock::time_point now() = 0;
  // False when told to stop before the time was over.
  virtual bool wait(std::chrono::milliseconds delay, const std::stop_token& stop) = 0;
};

Clock& system_clock();

}  // namespace skinframe::client
