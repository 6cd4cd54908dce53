// SPDX-License-Identifier: Apache-2.0
// What a store alone can do: jobs made, leased and completed a second, each durable when it counts.
#pragma once

#include "server/store/job_store.h"

namespace skinframe::bench {

struct Rates {
  double enqueue = 0;  // a second
  double lease = 0;
  double complete = 0;
  double cycle() const { return 1 / (1 / enqueue + 1 / lease + 1 / complete); }
};

// jobs jobs through all three steps, step by step, by so many callers at once: 1 waits for each commit, many
// share them.
Rates measure_rates(server::JobStore& store, int jobs, int callers);

struct LeaseCost {
  double quarter_us = 0;  // a quarter was quicker: what it costs while nothing else has the processor
  double median_us = 0;
  double p95_us = 0;
  double duties_quarter_us = 0;  // the look for expired leases and passed deadlines, ten times a second
};

// One caller leases `leases` jobs of a store that has `queued` of them, of `tenants` tenants; the queue is
// filled up first. The jobs go back into the queue after each look, so that its depth stays.
LeaseCost measure_lease_cost(server::JobStore& store, int queued, int tenants, int leases);

}  // namespace skinframe::bench
