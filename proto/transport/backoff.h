// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <random>

namespace skinframe::transport {

// How long to wait before asking again. The k-th delay lies between half of min(first * 2^k, longest) and all
// of it: callers that lost their server at one moment do not come back at one moment.
class Backoff {
 public:
  Backoff(std::chrono::milliseconds first, std::chrono::milliseconds longest,
          std::uint64_t seed = std::random_device{}());
  std::chrono::milliseconds next();
  void reset() { current_ = first_; }

 private:
  std::chrono::milliseconds first_, longest_, current_;
  std::mt19937_64 random_;
};

}  // namespace skinframe::transport
