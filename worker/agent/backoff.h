// SPDX-License-Identifier: GPL-3.0-or-later
// How long to wait before asking again: doubling, capped, with jitter, so that workers that lost their server
// at one moment do not come back at one moment.
#pragma once

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <random>
#include <stop_token>

namespace skinframe::agent {

class Backoff {
 public:
  Backoff(std::chrono::milliseconds first, std::chrono::milliseconds longest, std::uint64_t seed)
      : first_(first), longest_(longest), current_(first), random_(seed) {}

  // Between half of the current step and all of it; then the step doubles up to the longest.
  std::chrono::milliseconds next() {
    std::uniform_real_distribution<double> part(0.5, 1.0);
    const auto delay = std::chrono::milliseconds(
        static_cast<std::int64_t>(static_cast<double>(current_.count()) * part(random_)));
    current_ = std::min(current_ * 2, longest_);
    return delay;
  }
  void reset() { current_ = first_; }

 private:
  std::chrono::milliseconds first_, longest_, current_;
  std::mt19937_64 random_;
};

// False when told to stop before the time was over.
inline bool wait_unless_stopped(const std::stop_token& stop, std::chrono::milliseconds delay) {
  std::mutex mutex;
  std::condition_variable_any wake;
  std::unique_lock lock(mutex);
  wake.wait_for(lock, stop, delay, [] { return false; });
  return !stop.stop_requested();
}

}  // namespace skinframe::agent
