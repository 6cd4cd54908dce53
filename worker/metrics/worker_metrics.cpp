// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/metrics/worker_metrics.h"

namespace skinframe {
namespace {

using prometheus::BuildCounter;
using prometheus::BuildGauge;
using prometheus::BuildHistogram;

prometheus::Histogram::BucketBoundaries seconds() { return {0.1, 0.3, 1, 3, 10, 30, 100, 300, 1000, 3000}; }

}  // namespace

WorkerMetrics::WorkerMetrics()
    : registry_(std::make_shared<prometheus::Registry>()),
      slots_(BuildGauge()
                 .Name("skinframe_worker_slots")
                 .Help("Jobs that this worker runs at a time")
                 .Register(*registry_)
                 .Add({})),
      running_(BuildGauge()
                   .Name("skinframe_worker_jobs_running")
                   .Help("Jobs that this worker runs now")
                   .Register(*registry_)
                   .Add({})),
      attempts_(BuildCounter()
                    .Name("skinframe_worker_attempts_total")
                    .Help("Attempts that have ended here, by what the server was told")
                    .Register(*registry_)),
      heartbeats_(BuildCounter()
                      .Name("skinframe_worker_heartbeats_total")
                      .Help("Heartbeats, by the server's answer")
                      .Register(*registry_)),
      stages_(BuildHistogram()
                  .Name("skinframe_stage_seconds")
                  .Help("How long stages of jobs took, by stage")
                  .Register(*registry_)),
      iterations_(BuildCounter()
                      .Name("skinframe_solver_iterations_total")
                      .Help("Iterations of the optimiser, by stage")
                      .Register(*registry_)) {}

void WorkerMetrics::attempt_ended(const std::string& state, const std::string& reason) {
  running_.Decrement();
  attempts_.Add({{"state", state}, {"reason", reason}}).Increment();
}

void WorkerMetrics::heartbeat(const std::string& outcome) {
  heartbeats_.Add({{"outcome", outcome}}).Increment();
}

void WorkerMetrics::stage_took(const std::string& stage, double took) {
  stages_.Add({{"stage", stage}}, seconds()).Observe(took);
}

void WorkerMetrics::iterated(const std::string& stage, int times) {
  iterations_.Add({{"stage", stage}}).Increment(times);
}

}  // namespace skinframe
