// SPDX-License-Identifier: Apache-2.0
// What clients and workers see of a whole server on this machine, over real connections.
#pragma once

#include <string>

#include "server/app/options.h"

namespace skinframe::bench {

struct Spread {
  double p50_ms = 0;
  double p95_ms = 0;
  double p99_ms = 0;
};

// From the call of SubmitJob to the moment in which a worker that waited has the job: nothing else runs.
Spread measure_pick_up(const server::ServerOptions& options, int jobs);

struct Broadcast {
  Spread all_have_it;  // from the call of Heartbeat to the last watcher's event
  int watchers = 0;
};

// So many watch streams of one job over a few connections, and so many progress events, one after another.
Broadcast measure_watchers(const server::ServerOptions& options, int watchers, int events);

}  // namespace skinframe::bench
