// SPDX-License-Identifier: Apache-2.0
// How long a lease lasts, how often a job is tried, and how long it rests between attempts. Pure.
#pragma once

#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "server/jobs/clock.h"

namespace skinframe::server {

struct AttemptPolicy {
  Milliseconds lease{10'000};         // without a heartbeat for so long the job is taken back; 1 s .. 1 h
  Milliseconds heartbeat{500};        // workers heartbeat at least this often; 50 ms .. lease / 2
  int max_attempts = 3;               // lost attempts after which the job FAILED; 1 .. 100. Crashes count.
  Milliseconds first_backoff{1'000};  // rest after the first lost attempt; doubles with each further one
  Milliseconds max_backoff{60'000};
  Milliseconds longest_wait{30'000};  // of one Lease call

  // Names the first option that is out of its range.
  absl::Status validate() const;
};

// The rest after the n-th lost attempt (n >= 1): min(max_backoff, first_backoff 2^(n-1)), of which the upper
// half is jittered, so that jobs that died together do not come back together. jitter in [0, 1).
Milliseconds backoff_after(int lost_attempts, double jitter, const AttemptPolicy& policy);

// A number in [0, 1) that depends on the job and the attempt alone: jitter without a random generator, the
// same again when a decision is taken twice.
double jitter_of(std::string_view job_id, int lost_attempts);

}  // namespace skinframe::server
