// SPDX-License-Identifier: Apache-2.0
// What a store alone can do: jobs made, leased and completed a second, each durable when it counts.
#pragma once

#include <vector>

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
  double median_us = 0;
  double p95_us = 0;
  double duties_median_us = 0;  // the look for expired leases and passed deadlines, ten times a second
};

// Puts so many jobs of so many tenants into an empty store's queue.
void fill(server::JobStore& store, int queued, int tenants);

// One caller leases so many jobs of each store, in turn, so that what else the machine does meets all of them
// alike. The jobs go back into the queue after each look, so that its depth stays.
std::vector<LeaseCost> measure_lease_costs(const std::vector<server::JobStore*>& stores, int leases);

}  // namespace skinframe::bench
