// SPDX-License-Identifier: Apache-2.0
#include "proto/transport/channel.h"

#include <fmt/format.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>

#include <fstream>
#include <sstream>
#include <utility>

namespace skinframe::transport {
namespace {

absl::StatusOr<std::shared_ptr<grpc::ChannelCredentials>> credentials(const TlsFiles& tls) {
  if (tls.authority.empty()) return grpc::InsecureChannelCredentials();
  grpc::SslCredentialsOptions ssl;
  for (const auto& [file, pem] :
       {std::pair(&tls.authority, &ssl.pem_root_certs), std::pair(&tls.cert, &ssl.pem_cert_chain),
        std::pair(&tls.key, &ssl.pem_private_key)}) {
    if (file->empty()) continue;
    std::ifstream in(*file);
    std::stringstream text;
    text << in.rdbuf();
    *pem = text.str();
    if (!in || pem->empty()) {
      return absl::InvalidArgumentError(
          fmt::format("{}: no TLS certificate or key can be read there", file->string()));
    }
  }
  return grpc::SslCredentials(ssl);
}

}  // namespace

absl::StatusOr<std::shared_ptr<grpc::Channel>> open_channel(const ChannelOptions& options) {
  const auto secured = credentials(options.tls);
  if (!secured.ok()) return secured.status();
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, 20'000);
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, static_cast<int>(options.ping_timeout.count()));
  if (options.ping_without_data) arguments.SetInt(GRPC_ARG_HTTP2_MAX_PINGS_WITHOUT_DATA, 0);
  // A server that restarts is found again soon.
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 100);
  // A container that restarts has another address; gRPC would ask for it every 30 s at most.
  arguments.SetInt(GRPC_ARG_DNS_MIN_TIME_BETWEEN_RESOLUTIONS_MS, 1'000);
  arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS, 5'000);  // for one attempt, its TLS handshake included
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, static_cast<int>(options.longest_reconnect.count()));
  return grpc::CreateCustomChannel(options.address, *secured, arguments);
}

}  // namespace skinframe::transport
