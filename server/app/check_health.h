// SPDX-License-Identifier: Apache-2.0
// Asks a running server how it is, for the health checks of containers and service managers.
#pragma once

#include <string>

#include "absl/status/status.h"

namespace skinframe::server {

// OK when grpc.health.v1.Health/Check at host:port says SERVING; otherwise one sentence. Meant for this
// machine's own server: it tries TLS and then plaintext, and believes whatever certificate it is shown, for
// it sends nothing that is secret and must not need the server's files to ask. Takes 4 s at most.
absl::Status check_health(const std::string& address);

}  // namespace skinframe::server
