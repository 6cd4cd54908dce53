// SPDX-License-Identifier: Apache-2.0
#include "proto/transport/backoff.h"

#include <algorithm>

namespace skinframe::transport {

Backoff::Backoff(std::chrono::milliseconds first, std::chrono::milliseconds longest, std::uint64_t seed)
    : first_(first), longest_(longest), current_(first), random_(seed) {}

std::chrono::milliseconds Backoff::next() {
  std::uniform_real_distribution<double> part(0.5, 1.0);
  const auto delay = std::chrono::milliseconds(
      static_cast<std::int64_t>(static_cast<double>(current_.count()) * part(random_)));
  current_ = std::min(current_ * 2, longest_);
  return delay;
}

}  // namespace skinframe::transport
