// SPDX-License-Identifier: Apache-2.0
#include "proto/transport/sha256.h"

#include <gtest/gtest.h>

#include <sstream>

namespace skinframe::transport {
namespace {

TEST(Sha256Test, IsThatOfTheStandard) {  // FIPS 180-2, appendix B.1
  std::istringstream abc("abc");
  EXPECT_EQ(digest_of(abc).sha256, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Sha256Test, OfAStreamIsThatOfItsPartsAndTellsItsSize) {
  std::istringstream stream(std::string(700'000, 'a') + std::string(5, 'b'));
  Sha256 parts;
  parts.add(std::string(700'000, 'a'));
  parts.add("bbbbb");
  const FileDigest whole = digest_of(stream);
  EXPECT_EQ(whole.size_bytes, 700'005);
  EXPECT_EQ(whole.sha256, parts.hex());
}

}  // namespace
}  // namespace skinframe::transport
