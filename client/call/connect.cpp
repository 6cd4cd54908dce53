// SPDX-License-Identifier: Apache-2.0
#include "client/call/connect.h"

#include <fmt/format.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>

#include <fstream>
#include <sstream>
#include <utility>

namespace skinframe::client {

Result<Connection> connect(const ConnectOptions& options) {
  if (options.address.empty())
    return Failure{FailureKind::kUsage, "the server's address is empty; give HOST:PORT"};
  if (options.tls_cert.empty() != options.tls_key.empty())
    return Failure{FailureKind::kUsage, "a TLS certificate and its key must be given together"};
  if (!options.tls_cert.empty() && options.tls_ca.empty())
    return Failure{FailureKind::kUsage, "a TLS certificate of the caller needs the authority's (--tls-ca)"};
  std::shared_ptr<grpc::ChannelCredentials> credentials = grpc::InsecureChannelCredentials();
  if (!options.tls_ca.empty()) {
    grpc::SslCredentialsOptions ssl;
    for (const auto& [file, pem] :
         {std::pair(&options.tls_ca, &ssl.pem_root_certs), std::pair(&options.tls_cert, &ssl.pem_cert_chain),
          std::pair(&options.tls_key, &ssl.pem_private_key)}) {
      if (file->empty()) continue;
      std::ifstream in(*file);
      std::stringstream text;
      text << in.rdbuf();
      *pem = text.str();
      if (!in || pem->empty())
        return Failure{FailureKind::kLocal,
                       fmt::format("{}: no TLS certificate or key can be read there", file->string())};
    }
    credentials = grpc::SslCredentials(ssl);
  }
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, 20'000);
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, 10'000);
  arguments.SetInt(GRPC_ARG_HTTP2_MAX_PINGS_WITHOUT_DATA, 0);  // a watcher only listens
  // A server that restarts is found again soon.
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 100);
  // A container that restarts has another address; gRPC would ask for it every 30 s at most.
  arguments.SetInt(GRPC_ARG_DNS_MIN_TIME_BETWEEN_RESOLUTIONS_MS, 1'000);
  arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS, 5'000);  // for one attempt, its TLS handshake included
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 1'000);
  Connection connection;
  connection.address = options.address;
  connection.token = options.token;
  connection.channel = grpc::CreateCustomChannel(options.address, credentials, arguments);
  return connection;
}

}  // namespace skinframe::client
