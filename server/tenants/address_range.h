// SPDX-License-Identifier: Apache-2.0
// A range of network addresses, as "10.1.0.0/16", "fd00::/8", "10.1.2.3", or "unix" for sockets of this
// machine.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"

namespace skinframe::server {

class AddressRange {
 public:
  // INVALID_ARGUMENT names the text.
  static absl::StatusOr<AddressRange> parse(const std::string& text);

  // peer: as gRPC names it, "ipv4:10.1.2.3:50000", "ipv6:[fd00::1]:50000" (the brackets may be written %5B
  // and %5D), "unix:...". An IPv4 address within IPv6 (::ffff:10.1.2.3) counts as itself.
  bool contains(std::string_view peer) const;

 private:
  int family_ = 0;  // AF_INET, AF_INET6 or AF_UNIX
  std::array<unsigned char, 16> bytes_{};
  int prefix_bits_ = 0;
};

}  // namespace skinframe::server
