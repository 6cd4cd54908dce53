// SPDX-License-Identifier: Apache-2.0
// What an address to listen on says.
#pragma once

#include <string>
#include <string_view>

#include "absl/status/status.h"

namespace skinframe::server {

// INVALID_ARGUMENT: not host:port with a port of 0 .. 65535. "[::1]:7350" for IPv6.
absl::Status check_listen_address(std::string_view address);

// Only this machine can reach it: 127.0.0.0/8, ::1 or localhost. Of a valid address.
bool is_loopback(std::string_view address);

// The address with the port that was bound.
std::string with_port(std::string_view address, int port);

}  // namespace skinframe::server
