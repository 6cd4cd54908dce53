// SPDX-License-Identifier: GPL-3.0-or-later
// A WorkerService that hands out what a test puts into its queue and keeps what it is told.
#pragma once

#include <google/protobuf/util/time_util.h>
#include <grpcpp/grpcpp.h>

#include <condition_variable>
#include <deque>
#include <mutex>
#include <vector>

#include "skinframe/v1/worker.grpc.pb.h"

namespace skinframe::agent {

class FakeWorkerService final : public v1::WorkerService::Service {
 public:
  std::mutex mutex;
  std::condition_variable changed;
  std::deque<v1::Assignment> queue;
  int asked = 0;
  std::vector<v1::HeartbeatRequest> heartbeats;
  std::vector<v1::CompleteRequest> completions;
  std::vector<v1::CheckpointRequest> checkpoints;
  bool cancel = false;
  bool take_lease_away = false;
  int refuse_completions = 0;
  grpc::StatusCode refusal = grpc::StatusCode::UNAVAILABLE;
  bool refused = false;
  int beats_after_refusal = 0;
  bool stopping = false;

  grpc::Status Lease(grpc::ServerContext* context, const v1::LeaseRequest*,
                     v1::LeaseResponse* response) override {
    std::unique_lock lock(mutex);
    ++asked;
    changed.notify_all();
    while (queue.empty() && !stopping && !context->IsCancelled()) {
      changed.wait_for(lock, std::chrono::milliseconds(5));
    }
    if (queue.empty()) return {grpc::StatusCode::UNAVAILABLE, "stopping"};
    *response->mutable_assignment() = queue.front();
    queue.pop_front();
    return grpc::Status::OK;
  }

  grpc::Status Heartbeat(grpc::ServerContext*, const v1::HeartbeatRequest* request,
                         v1::HeartbeatResponse* response) override {
    const std::lock_guard lock(mutex);
    heartbeats.push_back(*request);
    if (refused) ++beats_after_refusal;
    changed.notify_all();
    if (take_lease_away) return {grpc::StatusCode::ABORTED, "another worker has the job"};
    response->set_cancel(cancel);
    *response->mutable_lease_left() = google::protobuf::util::TimeUtil::SecondsToDuration(10);
    return grpc::Status::OK;
  }

  grpc::Status Checkpoint(grpc::ServerContext*, const v1::CheckpointRequest* request,
                          v1::CheckpointResponse*) override {
    const std::lock_guard lock(mutex);
    checkpoints.push_back(*request);
    changed.notify_all();
    return grpc::Status::OK;
  }

  grpc::Status Complete(grpc::ServerContext*, const v1::CompleteRequest* request,
                        v1::CompleteResponse*) override {
    const std::lock_guard lock(mutex);
    if (refuse_completions-- > 0) {
      refused = true;
      return {refusal, "not now"};
    }
    completions.push_back(*request);
    changed.notify_all();
    return grpc::Status::OK;
  }
};

}  // namespace skinframe::agent
