// SPDX-License-Identifier: Apache-2.0
// Time as the library sees it, so that a test of an hour's backoff takes no time.
#pragma once

#include <grpcpp/channel.h>

#include <chrono>
#include <memory>
#include <stop_token>

namespace skinframe::client {

class Clock {
 public:
  virtual ~Clock() = default;
  virtual std::chrono::steady_clock::time_point now() = 0;
  // False when told to stop before the time was over.
  virtual bool wait(std::chrono::milliseconds delay, const std::stop_token& stop) = 0;
};

Clock& system_clock();

// The same, whose waits drive the channel. gRPC gets on with connecting only while somebody waits for the
// channel: calls that fail at once, with sleep between them, would leave a TLS handshake unfinished for ever.
std::shared_ptr<Clock> connecting_clock(std::shared_ptr<grpc::Channel> channel);

}  // namespace skinframe::client
