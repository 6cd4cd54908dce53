// SPDX-License-Identifier: Apache-2.0
// skinframe.v1.WorkerService. What each call promises stands in worker.proto.
#pragma once

#include "server/api/parts.h"
#include "skinframe/v1/worker.grpc.pb.h"

namespace skinframe::server {

class WorkerService final : public v1::WorkerService::CallbackService {
 public:
  explicit WorkerService(const Parts& parts) : parts_(parts) {}

  grpc::ServerUnaryReactor* Lease(grpc::CallbackServerContext* context, const v1::LeaseRequest* request,
                                  v1::LeaseResponse* response) override;
  grpc::ServerUnaryReactor* Heartbeat(grpc::CallbackServerContext* context,
                                      const v1::HeartbeatRequest* request,
                                      v1::HeartbeatResponse* response) override;
  grpc::ServerUnaryReactor* Checkpoint(grpc::CallbackServerContext* context,
                                       const v1::CheckpointRequest* request,
                                       v1::CheckpointResponse* response) override;
  grpc::ServerUnaryReactor* Complete(grpc::CallbackServerContext* context, const v1::CompleteRequest* request,
                                     v1::CompleteResponse* response) override;

 private:
  absl::Status heartbeat(const v1::HeartbeatRequest& request, v1::HeartbeatResponse& response);
  absl::StatusOr<JobRecord> look_first(const v1::HeartbeatRequest& request, const Decide& decide);
  absl::Status checkpoint(const v1::CheckpointRequest& request);
  absl::Status complete(const v1::CompleteRequest& request);

  Parts parts_;
};

}  // namespace skinframe::server
