// SPDX-License-Identifier: Apache-2.0
#include "server/api/answer.h"

#include <spdlog/spdlog.h>

#include <string>
#include <utility>

namespace skinframe::server {
namespace {

// gRPC carries the message in a header, and clients refuse headers of more than 8 KiB; messages quote what
// was sent.
constexpr std::size_t kLongestMessage = 1024;
constexpr std::string_view kCut = "...";

// At the boundary of a character of UTF-8.
std::string shortened(std::string message) {
  if (message.size() <= kLongestMessage) return message;
  std::size_t end = kLongestMessage - kCut.size();
  while (end > 0 && (static_cast<unsigned char>(message[end]) & 0xC0) == 0x80) --end;
  message.resize(end);
  return message.append(kCut);
}

}  // namespace

grpc::Status to_grpc(const absl::Status& status, std::string_view job_id) {
  if (status.ok()) return grpc::Status::OK;
  std::string message = shortened(std::string(status.message()));
  if (absl::IsInternal(status) || absl::IsUnknown(status)) {
    if (job_id.empty()) {
      spdlog::error("a call failed: {}", message);
    } else {
      spdlog::error("job={} a call failed: {}", job_id, message);
    }
  }
  return {static_cast<grpc::StatusCode>(status.code()), std::move(message)};
}

grpc::ServerUnaryReactor* answer_on(Executor& executor, grpc::CallbackServerContext* context,
                                    std::function<absl::Status()> work, std::string_view job_id) {
  grpc::ServerUnaryReactor* reactor = context->DefaultReactor();
  executor.post([reactor, work = std::move(work), job_id] { reactor->Finish(to_grpc(work(), job_id)); });
  return reactor;
}

}  // namespace skinframe::server
