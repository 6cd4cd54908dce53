// SPDX-License-Identifier: Apache-2.0
// A channel to a server that may restart, move to another address, or be cut off without a word.
#pragma once

#include <grpcpp/channel.h>
#include <grpcpp/support/channel_arguments.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>

#include "absl/status/statusor.h"

namespace skinframe::transport {

// PEM files; all empty: no TLS.
struct TlsFiles {
  std::filesystem::path authority;  // whose certificates the server's must be of
  std::filesystem::path cert;       // by which the server knows the caller; with key, or none
  std::filesystem::path key;
};

struct ChannelOptions {
  std::string address;  // HOST:PORT
  TlsFiles tls;
  std::chrono::milliseconds ping_timeout{10'000};      // a silent server is noticed after this and 20 s
  std::chrono::milliseconds longest_reconnect{1'000};  // between two attempts to connect
  bool ping_without_data = false;                      // as one must who only listens
};

// Does not talk to the server yet. INVALID_ARGUMENT: a file holds no certificate or key that can be read, and
// which.
absl::StatusOr<std::shared_ptr<grpc::Channel>> open_channel(const ChannelOptions& options);

}  // namespace skinframe::transport
