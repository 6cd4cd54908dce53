// SPDX-License-Identifier: Apache-2.0
#include "server/api/answer.h"

#include <spdlog/spdlog.h>

#include <string>
#include <utility>

namespace skinframe::server {

grpc::Status to_grpc(const absl::Status& status) {
  if (status.ok()) return grpc::Status::OK;
  const std::string message(status.message());
  if (absl::IsInternal(status) || absl::IsUnknown(status)) spdlog::error("a call failed: {}", message);
  return {static_cast<grpc::StatusCode>(status.code()), message};
}

grpc::ServerUnaryReactor* answer_on(Executor& executor, grpc::CallbackServerContext* context,
                                    std::function<absl::Status()> work) {
  grpc::ServerUnaryReactor* reactor = context->DefaultReactor();
  executor.post([reactor, work = std::move(work)] { reactor->Finish(to_grpc(work())); });
  return reactor;
}

}  // namespace skinframe::server
