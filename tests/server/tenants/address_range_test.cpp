// SPDX-License-Identifier: Apache-2.0
#include "server/tenants/address_range.h"

#include <gtest/gtest.h>

namespace skinframe::server {
namespace {

bool contains(const std::string& range, const std::string& peer) {
  const auto parsed = AddressRange::parse(range);
  EXPECT_TRUE(parsed.ok()) << parsed.status();
  return parsed.ok() && parsed->contains(peer);
}

TEST(AddressRange, ContainsWhatSharesItsPrefix) {
  EXPECT_TRUE(contains("10.1.0.0/16", "ipv4:10.1.200.3:50000"));
  EXPECT_FALSE(contains("10.1.0.0/16", "ipv4:10.2.0.1:50000"));
  EXPECT_TRUE(contains("10.1.2.128/25", "ipv4:10.1.2.129:1"));
  EXPECT_FALSE(contains("10.1.2.128/25", "ipv4:10.1.2.127:1"));
  EXPECT_TRUE(contains("127.0.0.1", "ipv4:127.0.0.1:1"));
  EXPECT_FALSE(contains("127.0.0.1", "ipv4:127.0.0.2:1"));
  EXPECT_TRUE(contains("0.0.0.0/0", "ipv4:8.8.8.8:1"));
  EXPECT_TRUE(contains("fd00::/8", "ipv6:[fd12::1]:50000"));
  EXPECT_TRUE(contains("fd00::/8", "ipv6:%5Bfd12::1%5D:50000"));
  EXPECT_FALSE(contains("fd00::/8", "ipv6:[fe80::1]:50000"));
  EXPECT_TRUE(contains("unix", "unix:/run/skinframe.sock"));
  EXPECT_FALSE(contains("unix", "ipv4:127.0.0.1:1"));
}

TEST(AddressRange, AFamilyDoesNotContainTheOtherButAMappedAddressIsItself) {
  EXPECT_FALSE(contains("0.0.0.0/0", "ipv6:[fd12::1]:1"));
  EXPECT_FALSE(contains("::/0", "ipv4:10.1.2.3:1"));
  EXPECT_TRUE(contains("10.1.0.0/16", "ipv6:[::ffff:10.1.2.3]:1"));
}

TEST(AddressRange, WhatIsNoRangeIsRefusedAndNothingIsInNoise) {
  for (const char* text : {"", "10.1.0.0/33", "10.1.0.0/-1", "10.1.0.0/", "farm", "fd00::/129", "10.1"})
    EXPECT_FALSE(AddressRange::parse(text).ok()) << text;
  for (const char* peer : {"", "ipv4:", "ipv6:", "ipv4:x:1", "ipv6:[", "dns:farm"})
    EXPECT_FALSE(contains("0.0.0.0/0", peer)) << peer;
}

}  // namespace
}  // namespace skinframe::server
