// SPDX-License-Identifier: Apache-2.0
// One Lease call: waits at the lease desk, and leaves it when the worker hangs up.
#pragma once

#include <grpcpp/grpcpp.h>

#include <memory>
#include <mutex>
#include <optional>

#include "server/api/parts.h"
#include "skinframe/v1/worker.grpc.pb.h"

namespace skinframe::server {

class LeaseCall final : public grpc::ServerUnaryReactor {
 public:
  // The call owns itself until gRPC is done with it. permitted: whether the caller is a worker.
  static grpc::ServerUnaryReactor* start(const Parts& parts, const absl::Status& permitted,
                                         const v1::LeaseRequest& request, v1::LeaseResponse& response);
  void OnCancel() override;
  void OnDone() override;

 private:
  LeaseCall(const Parts& parts, v1::LeaseResponse& response) : parts_(parts), response_(response) {}
  void wait_at_desk(const v1::LeaseRequest& request);
  void answer(const absl::StatusOr<std::optional<JobRecord>>& leased);

  Parts parts_;
  v1::LeaseResponse& response_;
  std::mutex mutex_;  // guards what follows
  LeaseDesk::Ticket ticket_ = 0;
  bool cancelled_ = false;
  std::shared_ptr<LeaseCall> self_;
};

}  // namespace skinframe::server
