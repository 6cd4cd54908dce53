// SPDX-License-Identifier: Apache-2.0
// Try again where the API says that it may help, for as long as the caller has patience.
#pragma once

#include <grpcpp/client_context.h>
#include <grpcpp/support/status.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>

#include "client/call/connect.h"
#include "proto/transport/backoff.h"

namespace skinframe::client {

using transport::Backoff;

struct RetryPolicy {
  int attempts = 4;                            // in all, >= 1
  std::chrono::milliseconds first{100};        // delay after the first
  std::chrono::milliseconds longest{2000};     // delay at most
  std::chrono::milliseconds deadline{30'000};  // of one attempt
  bool queue_full = false;                     // RESOURCE_EXHAUSTED too, where the server names a delay
};

using Attempt = std::function<grpc::Status(grpc::ClientContext&)>;

// How long the server asks to wait before the next attempt (RetryInfo, skinframe/v1/status.proto), at most 30
// s; nothing: it does not say. An answer of another server's making is no reason to fail.
std::optional<std::chrono::milliseconds> asked_delay(const grpc::Status& status);

// Runs attempts until one gives something that trying again cannot mend, none sooner than the server asks.
// CANCELLED when stopped.
grpc::Status call_with_retries(const Connection& connection, const RetryPolicy& policy,
                               const Attempt& attempt);

// One attempt under the connection's stop token.
grpc::Status call_once(const Connection& connection, std::chrono::milliseconds deadline,
                       const Attempt& attempt);

// A number, 0 or more, of the metadata behind a finished call's answer; nothing when it is not there.
std::optional<std::int64_t> trailing_number(const grpc::ClientContext& context, const char* key);

// A status that is not OK, as a sentence for people.
Failure to_failure(const grpc::Status& status, const Connection& connection);

}  // namespace skinframe::client
