// SPDX-License-Identifier: GPL-3.0-or-later
// What the next heartbeat tells. Between two heartbeats a fast stage says more than a person can read: lines
// of one printer, stage and iteration are replaced by the newest, and a full batch gives up its oldest ticks.
// While nothing new is said the last known progress is told again, so that a watcher sees the job alive.
// Not thread-safe.
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "skinframe/v1/job.pb.h"
#include "skinframe/v1/worker.pb.h"

namespace skinframe::agent {

class ProgressBatch {
 public:
  static constexpr std::size_t kMaxProgress = 100;  // HeartbeatRequest.progress

  void add(v1::JobProgress progress);
  void add(v1::PrinterResult printer);

  // Moves what is pending into the request.
  void take(v1::HeartbeatRequest& request);
  // The request did not arrive: its content comes before what was added since.
  void give_back(const v1::HeartbeatRequest& request);
  bool empty() const { return progress_.empty() && printers_.empty(); }

 private:
  void trim();

  std::deque<v1::JobProgress> progress_;
  std::deque<v1::PrinterResult> printers_;
  std::optional<v1::JobProgress> last_;
};

}  // namespace skinframe::agent
