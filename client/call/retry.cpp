// SPDX-License-Identifier: Apache-2.0
#include "client/call/retry.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string>

#include "skinframe/v1/status.pb.h"

namespace skinframe::client {
namespace {

constexpr std::chrono::milliseconds kLongestAskedDelay{30'000};

constexpr char kRetryInfo[] = "type.googleapis.com/google.rpc.RetryInfo";

bool may_help(const grpc::Status& status, const RetryPolicy& policy, bool delay_is_named) {
  return status.error_code() == grpc::StatusCode::UNAVAILABLE ||
         (policy.queue_full && delay_is_named && status.error_code() == grpc::StatusCode::RESOURCE_EXHAUSTED);
}

// gRPC's "failed to connect to all addresses; last error: UNKNOWN: ipv4:...: Connection refused" by its last
// part.
std::string last_part(const std::string& message) {
  const std::size_t colon = message.rfind(": ");
  return colon == std::string::npos ? message : message.substr(colon + 2);
}

grpc::Status interrupted() { return {grpc::StatusCode::CANCELLED, "interrupted"}; }

}  // namespace

std::optional<std::chrono::milliseconds> asked_delay(const grpc::Status& status) {
  v1::StatusDetails details;
  if (status.error_details().empty() || !details.ParseFromString(status.error_details())) return std::nullopt;
  for (const google::protobuf::Any& detail : details.details()) {
    v1::RetryInfo retry;
    if (detail.type_url() != kRetryInfo || !retry.ParseFromString(detail.value())) continue;
    const auto seconds = std::clamp<std::int64_t>(retry.retry_delay().seconds(), 0, 3600);
    const std::chrono::milliseconds delay(seconds * 1000 + retry.retry_delay().nanos() / 1'000'000);
    return std::clamp(delay, std::chrono::milliseconds(0), kLongestAskedDelay);
  }
  return std::nullopt;
}

std::optional<std::int64_t> trailing_number(const grpc::ClientContext& context, const char* key) {
  const auto& metadata = context.GetServerTrailingMetadata();
  const auto it = metadata.find(key);
  if (it == metadata.end()) return std::nullopt;
  std::int64_t value = 0;
  const char* end = it->second.data() + it->second.size();
  const auto [at, error] = std::from_chars(it->second.data(), end, value);
  if (error != std::errc() || at != end || value < 0) return std::nullopt;
  return value;
}

grpc::Status call_once(const Connection& connection, std::chrono::milliseconds deadline,
                       const Attempt& attempt) {
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + deadline);
  if (!connection.token.empty()) context.AddMetadata("authorization", "Bearer " + connection.token);
  const std::stop_callback cancel(connection.stop, [&] { context.TryCancel(); });
  return attempt(context);
}

grpc::Status call_with_retries(const Connection& connection, const RetryPolicy& policy,
                               const Attempt& attempt) {
  Backoff backoff(policy.first, policy.longest);
  for (int left = policy.attempts; !connection.stop.stop_requested();) {
    const grpc::Status status = call_once(connection, policy.deadline, attempt);
    const auto asked = asked_delay(status);
    if (--left <= 0 || !may_help(status, policy, asked.has_value())) return status;
    const auto delay = backoff.next();
    if (!connection.clock->wait(std::max(delay, asked.value_or(delay)), connection.stop)) break;
  }
  return interrupted();
}

Failure to_failure(const grpc::Status& status, const Connection& connection) {
  const std::string& message = status.error_message();
  if (connection.stop.stop_requested()) return {FailureKind::kInterrupted, "interrupted"};
  switch (status.error_code()) {
    case grpc::StatusCode::INVALID_ARGUMENT:
    case grpc::StatusCode::ALREADY_EXISTS:
    case grpc::StatusCode::FAILED_PRECONDITION:
    case grpc::StatusCode::OUT_OF_RANGE:
      return {FailureKind::kUsage, message};
    case grpc::StatusCode::UNIMPLEMENTED:
      return {FailureKind::kUsage, message.empty() ? "the server does not build this" : message};
    case grpc::StatusCode::NOT_FOUND:
      return {FailureKind::kNotFound, message};
    case grpc::StatusCode::UNAVAILABLE:
      return {
          FailureKind::kUnreachable,
          fmt::format("no server answers at {} ({}); start one with `skinframe-server --data DIR`, or name "
                      "another with --server HOST:PORT or SKINFRAME_SERVER",
                      connection.address, last_part(message))};
    case grpc::StatusCode::DEADLINE_EXCEEDED:
      return {FailureKind::kUnreachable,
              fmt::format("the server at {} does not answer in time; try again later", connection.address)};
    case grpc::StatusCode::RESOURCE_EXHAUSTED:
      return {FailureKind::kUnreachable, fmt::format("the server at {} has no room now: {}; try again later",
                                                     connection.address, message)};
    case grpc::StatusCode::UNAUTHENTICATED:
    case grpc::StatusCode::PERMISSION_DENIED:
      return {FailureKind::kUsage, fmt::format("the server at {} refuses: {}", connection.address, message)};
    default:
      break;
  }
  return {FailureKind::kInternal, fmt::format("the server at {}: {}", connection.address, message)};
}

}  // namespace skinframe::client
