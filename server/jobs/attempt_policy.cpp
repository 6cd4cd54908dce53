// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/attempt_policy.h"

#include <algorithm>
#include <cstdint>

namespace skinframe::server {

absl::Status AttemptPolicy::validate() const {
  using std::chrono::hours;
  using std::chrono::seconds;
  if (lease < seconds(1) || lease > hours(1)) {
    return absl::InvalidArgumentError("lease must be within 1 .. 3600 seconds");
  }
  if (heartbeat < Milliseconds(50) || heartbeat > lease / 2) {
    return absl::InvalidArgumentError("heartbeat must be within 0.05 seconds .. half of the lease");
  }
  if (ageing < seconds(1) || ageing > hours(24)) {
    return absl::InvalidArgumentError("ageing must be within 1 .. 86400 seconds");
  }
  if (max_attempts < 1 || max_attempts > 100) {
    return absl::InvalidArgumentError("max-attempts must be within 1 .. 100");
  }
  return absl::OkStatus();
}

Milliseconds backoff_after(int lost_attempts, double jitter, const AttemptPolicy& policy) {
  Milliseconds rest = policy.first_backoff;
  for (int i = 1; i < lost_attempts && rest < policy.max_backoff; ++i) rest *= 2;
  rest = std::min(rest, policy.max_backoff);
  return rest / 2 + Milliseconds(static_cast<std::int64_t>(jitter * static_cast<double>((rest / 2).count())));
}

std::int64_t rank_ms(Time submitted, int priority, const AttemptPolicy& policy) {
  return submitted.time_since_epoch().count() - priority * policy.ageing.count();
}

double jitter_of(std::string_view job_id, int lost_attempts) {
  // FNV-1a and a final mix: evenly spread, and not secret.
  std::uint64_t hash = 14695981039346656037ull;
  for (const char c : job_id) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  hash = (hash ^ static_cast<std::uint64_t>(lost_attempts)) * 1099511628211ull;
  hash ^= hash >> 32;
  hash *= 0x9E3779B97F4A7C15ull;
  return static_cast<double>(hash >> 11) * 0x1.0p-53;
}

}  // namespace skinframe::server
