// SPDX-License-Identifier: Apache-2.0
#include "server/api/answer.h"

#include <spdlog/spdlog.h>

#include <string>
#include <utility>

#include "server/jobs/clock.h"
#include "skinframe/v1/status.pb.h"

namespace skinframe::server {
namespace {

// gRPC carries the message in a header, and clients refuse headers of more than 8 KiB; messages quote what
// was sent.
constexpr std::size_t kLongestMessage = 1024;
constexpr std::string_view kCut = "...";

// A server is back, and a place in a queue free, after about so long; whoever finds it is not backs off from
// there.
constexpr Milliseconds kRetryDelay{1'000};
constexpr char kRetryInfo[] = "type.googleapis.com/google.rpc.RetryInfo";
constexpr char kWaitingDoesNotHelp[] = "skinframe/waiting-does-not-help";

bool waiting_helps(const absl::Status& status) {
  return (absl::IsUnavailable(status) || absl::IsResourceExhausted(status)) &&
         !status.GetPayload(kWaitingDoesNotHelp).has_value();
}

std::string retry_details(grpc::StatusCode code, const std::string& message) {
  v1::RetryInfo retry;
  *retry.mutable_retry_delay() = to_duration(kRetryDelay);
  v1::StatusDetails details;
  details.set_code(code);
  details.set_message(message);
  google::protobuf::Any& info = *details.add_details();
  info.set_type_url(kRetryInfo);
  retry.SerializeToString(info.mutable_value());
  return details.SerializeAsString();
}

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
  const auto code = static_cast<grpc::StatusCode>(status.code());
  std::string details = waiting_helps(status) ? retry_details(code, message) : "";
  return {code, std::move(message), std::move(details)};
}

absl::Status waiting_does_not_help(absl::Status status) {
  status.SetPayload(kWaitingDoesNotHelp, absl::Cord());
  return status;
}

grpc::ServerUnaryReactor* answer_on(Executor& executor, grpc::CallbackServerContext* context,
                                    std::function<absl::Status()> work, std::string_view job_id) {
  grpc::ServerUnaryReactor* reactor = context->DefaultReactor();
  executor.post([reactor, work = std::move(work), job_id] { reactor->Finish(to_grpc(work(), job_id)); });
  return reactor;
}

}  // namespace skinframe::server
