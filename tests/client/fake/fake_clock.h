// SPDX-License-Identifier: Apache-2.0
// A clock whose waits take no time and are remembered.
#pragma once

#include <vector>

#include "client/call/clock.h"

namespace skinframe::fake {

class FakeClock final : public client::Clock {
 public:
  std::chrono::steady_clock::time_point now() override { return time_; }
  bool wait(std::chrono::milliseconds delay, const std::stop_token& stop) override {
    waits.push_back(delay);
    time_ += delay;
    return !stop.stop_requested();
  }
  void advance(std::chrono::milliseconds by) { time_ += by; }

  std::vector<std::chrono::milliseconds> waits;

 private:
  std::chrono::steady_clock::time_point time_{};
};

}  // namespace skinframe::fake
