// SPDX-License-Identifier: Apache-2.0
#include "client/call/connect.h"

#include <string>
#include <utility>

#include "proto/transport/channel.h"

namespace skinframe::client {

Result<Connection> connect(const ConnectOptions& options) {
  if (options.address.empty())
    return Failure{FailureKind::kUsage, "the server's address is empty; give HOST:PORT"};
  if (options.tls_cert.empty() != options.tls_key.empty())
    return Failure{FailureKind::kUsage, "a TLS certificate and its key must be given together"};
  if (!options.tls_cert.empty() && options.tls_ca.empty())
    return Failure{FailureKind::kUsage, "a TLS certificate of the caller needs the authority's (--tls-ca)"};
  transport::ChannelOptions how;
  how.address = options.address;
  how.tls = {options.tls_ca, options.tls_cert, options.tls_key};
  how.ping_without_data = true;  // a watcher only listens
  auto channel = transport::open_channel(how);
  if (!channel.ok()) return Failure{FailureKind::kLocal, std::string(channel.status().message())};
  Connection connection;
  connection.address = options.address;
  connection.token = options.token;
  connection.channel = *std::move(channel);
  connection.own_clock = connecting_clock(connection.channel);
  connection.clock = connection.own_clock.get();
  return connection;
}

}  // namespace skinframe::client
