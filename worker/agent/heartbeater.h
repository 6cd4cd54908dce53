// SPDX-License-Identifier: GPL-3.0-or-later
// Holds the lease of one job with a thread of its own, from the assignment until just before Complete: tells
// the progress, hears of cancellation and of the lease's loss, watches the deadline. It asks twice a second
// and more, whatever the lease's own interval is: that is how soon a cancellation arrives and how fresh
// progress is.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

#include "skinframe/v1/worker.grpc.pb.h"
#include "worker/agent/conclusion.h"
#include "worker/agent/progress_batch.h"
#include "worker/metrics/worker_metrics.h"

namespace skinframe::agent {

// While something runs a heartbeat goes out at least this often, however rarely the server asks for one.
// Without news it costs the server a read, until the lease needs prolonging.
inline constexpr std::chrono::milliseconds kHeartbeatPeriod{350};

class Heartbeater {
 public:
  // `worker_stop` is the agent's own end; it stops the job with StopCause::kWorkerStopped.
  Heartbeater(v1::WorkerService::StubInterface& stub, const v1::Assignment& assignment,
              std::stop_token worker_stop, WorkerMetrics& metrics);
  ~Heartbeater();
  Heartbeater(const Heartbeater&) = delete;
  Heartbeater& operator=(const Heartbeater&) = delete;

  void add(v1::JobProgress progress);
  void add(v1::PrinterResult printer);

  std::stop_token stop_token() const { return stop_.get_token(); }  // the job is to end
  StopCause cause() const { return cause_.load(); }

  // Sends what is pending and ends the thread. The lease then lasts until lease_expiry().
  void finish();
  // After finish(): one heartbeat more, for a completion that the server does not take yet.
  void prolong_lease() { beat(); }
  std::chrono::steady_clock::time_point lease_expiry() const;

 private:
  void run();
  void beat();
  void stop_job(StopCause cause);
  // The lease lasts so long after `from`, which is before the server's answer, so that it is never believed
  // in for too long whatever the two machines' clocks say.
  void prolong(const google::protobuf::Duration& left, std::chrono::steady_clock::time_point from);

  v1::WorkerService::StubInterface& stub_;
  WorkerMetrics& metrics_;
  const std::string job_id_;
  const std::int64_t fencing_token_;
  const std::chrono::milliseconds period_;
  std::chrono::system_clock::time_point deadline_;
  std::stop_source stop_;
  std::atomic<StopCause> cause_{StopCause::kNone};

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  bool finished_ = false;                           // guarded by mutex_
  ProgressBatch batch_;                             // guarded by mutex_
  std::chrono::steady_clock::time_point expiry_{};  // guarded by mutex_
  bool server_answers_ = true;                      // only the thread

  std::stop_callback<std::function<void()>> on_worker_stop_;
  std::thread thread_;
};

}  // namespace skinframe::agent
