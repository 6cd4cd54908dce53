// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/agent/heartbeater.h"

#include <google/protobuf/util/time_util.h>
#include <grpcpp/client_context.h>
#include <spdlog/spdlog.h>

#include <algorithm>

namespace skinframe::agent {
namespace {

using google::protobuf::util::TimeUtil;
using std::chrono::milliseconds;
using std::chrono::steady_clock;
using std::chrono::system_clock;

constexpr milliseconds kCallDeadline{2000};

system_clock::time_point to_system(const google::protobuf::Timestamp& time) {
  return system_clock::time_point(std::chrono::duration_cast<system_clock::duration>(
      std::chrono::nanoseconds(TimeUtil::TimestampToNanoseconds(time))));
}

milliseconds asked_interval(const v1::Assignment& assignment) {
  const milliseconds asked(TimeUtil::DurationToMilliseconds(assignment.heartbeat_interval()));
  return asked > milliseconds(0) ? asked : milliseconds(5000);
}

}  // namespace

Heartbeater::Heartbeater(v1::WorkerService::StubInterface& stub, const v1::Assignment& assignment,
                         std::stop_token worker_stop, WorkerMetrics& metrics)
    : stub_(stub),
      metrics_(metrics),
      job_id_(assignment.job_id()),
      fencing_token_(assignment.fencing_token()),
      period_(std::min(asked_interval(assignment), kHeartbeatPeriod)),
      deadline_(assignment.has_deadline() ? to_system(assignment.deadline())
                                          : system_clock::time_point::max()),
      on_worker_stop_(std::move(worker_stop), [this] { stop_job(StopCause::kWorkerStopped); }) {
  prolong(assignment.lease_duration(), steady_clock::now());
  thread_ = std::thread([this] { run(); });
}

Heartbeater::~Heartbeater() { finish(); }

void Heartbeater::add(v1::JobProgress progress) {
  const std::lock_guard lock(mutex_);
  batch_.add(std::move(progress));
}

void Heartbeater::add(v1::PrinterResult printer) {
  const std::lock_guard lock(mutex_);
  batch_.add(std::move(printer));
}

steady_clock::time_point Heartbeater::lease_expiry() const {
  const std::lock_guard lock(mutex_);
  return expiry_;
}

void Heartbeater::finish() {
  {
    const std::lock_guard lock(mutex_);
    if (finished_) return;
    finished_ = true;
  }
  wake_.notify_all();
  thread_.join();
  bool pending = false;
  {
    const std::lock_guard lock(mutex_);
    pending = !batch_.empty();
  }
  if (pending && cause_ != StopCause::kLeaseLost) beat();
}

void Heartbeater::run() {
  auto next = steady_clock::now() + period_;
  while (true) {
    {
      std::unique_lock lock(mutex_);
      wake_.wait_until(lock, next, [&] { return finished_; });
      if (finished_) return;
    }
    next = steady_clock::now() + period_;
    if (system_clock::now() >= deadline_) stop_job(StopCause::kDeadline);
    beat();
    if (cause_ == StopCause::kLeaseLost) return;
  }
}

void Heartbeater::beat() {
  v1::HeartbeatRequest request;
  request.set_job_id(job_id_);
  request.set_fencing_token(fencing_token_);
  {
    const std::lock_guard lock(mutex_);
    batch_.take(request);
  }
  grpc::ClientContext context;
  context.set_deadline(system_clock::now() + kCallDeadline);
  context.set_wait_for_ready(!server_answers_);  // the channel connects only while a call waits for it
  v1::HeartbeatResponse response;
  const auto asked = steady_clock::now();
  const grpc::Status status = stub_.Heartbeat(&context, request, &response);
  switch (status.error_code()) {
    case grpc::StatusCode::OK:
      metrics_.heartbeat("ok");
      if (!server_answers_) spdlog::info("job={} heartbeats arrive again", job_id_);
      server_answers_ = true;
      prolong(response.lease_left(), asked);
      if (response.cancel()) stop_job(StopCause::kCancelled);
      return;
    case grpc::StatusCode::ABORTED:
    case grpc::StatusCode::NOT_FOUND:
      metrics_.heartbeat("lease_lost");
      spdlog::warn("job={} the lease is lost: {}", job_id_, status.error_message());
      stop_job(StopCause::kLeaseLost);
      return;
    case grpc::StatusCode::INVALID_ARGUMENT:  // it would be refused again: better lose a tick than the lease
      metrics_.heartbeat("refused");
      spdlog::warn("job={} the server refused progress: {}", job_id_, status.error_message());
      return;
    default:
      break;
  }
  metrics_.heartbeat("failed");
  if (server_answers_) spdlog::warn("job={} heartbeat failed: {}", job_id_, status.error_message());
  server_answers_ = false;
  bool expired = false;
  {
    const std::lock_guard lock(mutex_);
    batch_.give_back(request);
    expired = steady_clock::now() >= expiry_;
  }
  if (expired) {
    spdlog::warn("job={} no heartbeat came through until the lease's expiry", job_id_);
    stop_job(StopCause::kLeaseLost);
  }
}

void Heartbeater::stop_job(StopCause cause) {
  // Losing the lease outranks what came before: the result is then nobody's.
  StopCause none = StopCause::kNone;
  if (!cause_.compare_exchange_strong(none, cause) && cause == StopCause::kLeaseLost) cause_ = cause;
  stop_.request_stop();
}

void Heartbeater::prolong(const google::protobuf::Duration& left, steady_clock::time_point from) {
  const std::lock_guard lock(mutex_);
  expiry_ = from + milliseconds(TimeUtil::DurationToMilliseconds(left));
}

}  // namespace skinframe::agent
