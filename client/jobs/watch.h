// SPDX-License-Identifier: Apache-2.0
// Every event of a job, in order, once, however often the stream breaks.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

#include "client/call/connect.h"
#include "skinframe/v1/job.pb.h"

namespace skinframe::client {

bool is_final(v1::JobState state);  // SUCCEEDED, FAILED or CANCELLED

// Called in the thread of watch_job. False: enough seen, stop watching.
using EventHandler = std::function<bool(const v1::JobEvent&)>;

struct WatchOptions {
  std::int64_t after_sequence = 0;        // 0: from the first event
  std::chrono::seconds patience{120};     // without an event or a living server, until kUnreachable
  std::function<void()> on_lost = [] {};  // the stream broke; called once until it stands again
  // The events first .. last are not there any more: the progress of a job that ended some time ago.
  std::function<void(std::int64_t first, std::int64_t last)> on_thinned = [](std::int64_t, std::int64_t) {};
};

// Returns after the final state's event, or when the handler has enough.
// Guarantee: the handler sees sequence numbers without repetition, and without a gap but those that
// on_thinned is told of before; kInternal when the server leaves one out without a word. kNotFound; kUsage:
// after_sequence is beyond the last event; kUnreachable; kInterrupted.
Done watch_job(const Connection& connection, const std::string& job_id, const WatchOptions& options,
               const EventHandler& handler);

}  // namespace skinframe::client
