// SPDX-License-Identifier: Apache-2.0
// How long a lease lasts, how often a job is tried, how long it rests between attempts, and how waiting
// weighs against priority. Pure.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "server/jobs/clock.h"

namespace skinframe::server {

struct AttemptPolicy {
  Milliseconds lease{20'000};     // without a heartbeat for so long the job is taken back; 1 s .. 1 h
  Milliseconds heartbeat{5'000};  // a lease is prolonged at least this often; 50 ms .. lease / 2
  Milliseconds cancel_patience{
      10'000};                        // a cancelled job whose worker has not stopped by then is taken from it
  int max_attempts = 3;               // lost attempts after which the job FAILED; 1 .. 100. Crashes count.
  Milliseconds first_backoff{1'000};  // rest after the first lost attempt; doubles with each further one
  Milliseconds max_backoff{60'000};
  Milliseconds longest_wait{30'000};  // of one Lease call
  Milliseconds ageing{600'000};       // of waiting weighs as much as one point of priority; 1 s .. 1 day

  // Names the first option that is out of its range.
  absl::Status validate() const;
};

// The rest after the n-th lost attempt (n >= 1): min(max_backoff, first_backoff 2^(n-1)), of which the upper
// half is jittered, so that jobs that died together do not come back together. jitter in [0, 1).
Milliseconds backoff_after(int lost_attempts, double jitter, const AttemptPolicy& policy);

// Where a job stands in its tenant's queue, smaller first: the time of its submission minus priority *
// ageing. So job a stands before b exactly when
//   priority_a + waited_a / ageing  >  priority_b + waited_b / ageing,
// at whatever moment that is asked: waiting raises all alike, and the order never changes while they wait. No
// job starves: one of priority p is overtaken only by jobs that come within (100 - p) * ageing after it.
std::int64_t rank_ms(Time submitted, int priority, const AttemptPolicy& policy);

// A number in [0, 1) that depends on the job and the attempt alone: jitter without a random generator, the
// same again when a decision is taken twice.
double jitter_of(std::string_view job_id, int lost_attempts);

}  // namespace skinframe::server
