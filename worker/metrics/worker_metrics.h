// SPDX-License-Identifier: GPL-3.0-or-later
// What a worker counts: its jobs, their stages and iterations, its heartbeats. From any thread. The endpoint
// (proto/metrics) shows it where the operator asks for it; counting costs nothing worth a switch.
#pragma once

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>

#include <memory>
#include <string>

namespace skinframe {

class WorkerMetrics {
 public:
  WorkerMetrics();

  void set_slots(int slots) { slots_.Set(slots); }
  void attempt_began() { running_.Increment(); }
  // state and reason as told to the server, "SUCCEEDED" and "NONE"; both "DROPPED" where the lease was lost.
  void attempt_ended(const std::string& state, const std::string& reason);
  // "ok", "lease_lost", "refused", "failed": it did not get through.
  void heartbeat(const std::string& outcome);
  void stage_took(const std::string& stage, double seconds);
  void iterated(const std::string& stage, int times);

  const std::shared_ptr<prometheus::Registry>& registry() const { return registry_; }

 private:
  std::shared_ptr<prometheus::Registry> registry_;
  prometheus::Gauge& slots_;
  prometheus::Gauge& running_;
  prometheus::Family<prometheus::Counter>& attempts_;
  prometheus::Family<prometheus::Counter>& heartbeats_;
  prometheus::Family<prometheus::Histogram>& stages_;
  prometheus::Family<prometheus::Counter>& iterations_;
};

}  // namespace skinframe
