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
  std::filesystem::path tls_cert;  // PEM chain by which the server knows the caller; with tls_key, or none
  std::filesystem::path tls_key;
  std::string
      token;  // by which the server knows the caller; empty: none. Without TLS the network can read it.
};

// A value to copy. Every call of the library ends soon after `stop` asks for it, with kInterrupted.
struct Connection {
  std::shared_ptr<grpc::Channel> channel;
  std::string address;
  std::string token;  // sent with each call
  Clock* clock = &system_clock();
  std::shared_ptr<Clock> own_clock;  // what `clock` is after connect(); null where a caller brings another
  std::stop_token stop;

  Connection with_stop(std::stop_token when) const {
    Connection copy = *this;
    copy.stop = std::move(when);
    return copy;
  }
};

// Does not talk to the server yet. kUsage: the address is empty; kLocal: the certificate cannot be read.
// A server that is cut off without a word is noticed after 30 s.
Result<Connection> connect(const ConnectOptions& options);

}  // namespace skinframe::client
