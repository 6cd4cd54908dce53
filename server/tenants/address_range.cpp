// SPDX-License-Identifier: Apache-2.0
#include "server/tenants/address_range.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <sys/socket.h>

#include <algorithm>
#include <charconv>
#include <optional>

namespace skinframe::server {
namespace {

struct Address {
  int family;
  std::array<unsigned char, 16> bytes{};
};

int bits_of(int family) { return family == AF_INET ? 32 : family == AF_INET6 ? 128 : 0; }

std::optional<Address> parse_address(const std::string& text) {
  Address address{AF_INET, {}};
  if (inet_pton(AF_INET, text.c_str(), address.bytes.data()) == 1) return address;
  address.family = AF_INET6;
  if (inet_pton(AF_INET6, text.c_str(), address.bytes.data()) != 1) return std::nullopt;
  constexpr std::array<unsigned char, 12> kMapped = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0xff};
  if (std::equal(kMapped.begin(), kMapped.end(), address.bytes.begin())) {
    Address inner{AF_INET, {}};
    std::copy_n(address.bytes.begin() + 12, 4, inner.bytes.begin());
    return inner;
  }
  return address;
}

// The address in what gRPC says of a peer.
std::optional<Address> address_of(std::string_view peer) {
  if (peer.starts_with("unix")) return Address{AF_UNIX, {}};
  const bool v6 = peer.starts_with("ipv6:");
  if (!v6 && !peer.starts_with("ipv4:")) return std::nullopt;
  peer.remove_prefix(5);
  peer = peer.substr(0, peer.rfind(':'));
  std::string host(peer);
  for (const auto& [mark, plain] : {std::pair{"%5B", "["}, std::pair{"%5D", "]"}}) {
    if (const auto at = host.find(mark); at != std::string::npos) host.replace(at, 3, plain);
  }
  if (v6 && host.size() > 2 && host.front() == '[' && host.back() == ']')
    host = host.substr(1, host.size() - 2);
  if (const auto zone = host.find('%'); zone != std::string::npos) host.resize(zone);
  return parse_address(host);
}

}  // namespace

absl::StatusOr<AddressRange> AddressRange::parse(const std::string& text) {
  AddressRange range;
  if (text == "unix") {
    range.family_ = AF_UNIX;
    return range;
  }
  const std::size_t slash = text.find('/');
  const auto address = parse_address(text.substr(0, slash));
  int bits = address ? bits_of(address->family) : 0;
  bool good = address.has_value();
  if (good && slash != std::string::npos) {
    const char* end = text.data() + text.size();
    const auto [at, error] = std::from_chars(text.data() + slash + 1, end, bits);
    good = error == std::errc() && at == end && bits >= 0 && bits <= bits_of(address->family);
  }
  if (!good) {
    return absl::InvalidArgumentError(
        fmt::format("\"{}\" is no address or range like 10.1.0.0/16, fd00::/8 or unix", text));
  }
  range.family_ = address->family;
  range.bytes_ = address->bytes;
  range.prefix_bits_ = bits;
  return range;
}

bool AddressRange::contains(std::string_view peer) const {
  const auto address = address_of(peer);
  if (!address || address->family != family_) return false;
  const auto whole = static_cast<std::size_t>(prefix_bits_ / 8);
  if (!std::equal(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(whole),
                  address->bytes.begin()))
    return false;
  const int rest = prefix_bits_ % 8;
  if (rest == 0) return true;
  const int mask = 0xff << (8 - rest) & 0xff;
  return (bytes_[whole] & mask) == (address->bytes[whole] & mask);
}

}  // namespace skinframe::server
