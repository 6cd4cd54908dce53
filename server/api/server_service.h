// SPDX-License-Identifier: Apache-2.0
// ServerService: see proto/skinframe/v1/server.proto.
#pragma once

#include "server/api/parts.h"
#include "skinframe/v1/server.grpc.pb.h"

namespace skinframe::server {

class ServerService final : public v1::ServerService::CallbackService {
 public:
  // store: "sqlite" or "postgresql".
  ServerService(const Parts& parts, std::string store) : parts_(parts), store_(std::move(store)) {}

  grpc::ServerUnaryReactor* GetServerInfo(grpc::CallbackServerContext* context,
                                          const v1::GetServerInfoRequest* request,
                                          v1::ServerInfo* response) override;

 private:
  absl::Status tell(const grpc::CallbackServerContext& context, v1::ServerInfo& response);

  const Parts parts_;
  const std::string store_;
};

}  // namespace skinframe::server
