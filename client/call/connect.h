// SPDX-License-Identifier: Apache-2.0
// The way to one server: channel, time, and the caller's wish to stop.
#pragma once

#include <grpcpp/channel.h>

#include <filesystem>
#include <memory>
#include <stop_token>
#include <string>

#include "client/call/clock.h"
#include "client/call/result.h"

namespace skinframe::client {

inline constexpr char kDefaultAddress[] = "127.0.0.1:7350";

struct ConnectOptions {
  std::string address = kDefaultAddress;  // HOST:PORT
  std::filesystem::path tls_ca;           // PEM file of the certificate authority; empty: no TLS
};

// A value to copy. Every call of the library ends soon after `stop` asks for it, with kInterrupted.
struct Connection {
  std::shared_ptr<grpc::Channel> channel;
  std::string address;
  Clock* clock = &system_clock();
  std::stop_token stop;

  Connection with_stop(std::stop_token token) const {
    Connection copy = *this;
    copy.stop = std::move(token);
    return copy;
  }
};

// Does not talk to the server yet. kUsage: the address is empty; kLocal: the certificate cannot be read.
// A server that is cut off without a word is noticed after 30 s.
Result<Connection> connect(const ConnectOptions& options);

}  // namespace skinframe::client
