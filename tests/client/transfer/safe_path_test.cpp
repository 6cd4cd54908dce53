// SPDX-License-Identifier: Apache-2.0
#include "client/transfer/safe_path.h"

#include <gtest/gtest.h>

namespace skinframe::client {
namespace {

TEST(SafePath, PlainNamesLeadIntoTheFolder) {
  const auto path = path_inside("out", "sinterstation-hiq/skin-frame.stl");
  ASSERT_TRUE(path.ok());
  EXPECT_EQ(*path, "out/sinterstation-hiq/skin-frame.stl");
  EXPECT_TRUE(path_inside("/x", "report.json").ok());
  EXPECT_TRUE(path_inside("out", "..report.json").ok());  // an odd name, but a name
}

TEST(SafePath, NothingLeadsOutOfIt) {
  for (const std::string bad : {"", "/etc/passwd", "..", "../x", "a/../../x", "a/..", "./x", "a/./b", "a//b",
                                "a/", "/", "a\\..\\x", "a\nb", "a\x7f"}) {
    const auto path = path_inside("out", bad);
    ASSERT_FALSE(path.ok()) << bad;
    EXPECT_EQ(path.failure().kind, FailureKind::kInternal);
  }
  EXPECT_FALSE(path_inside("out", std::string("a\0b", 3)).ok());
  EXPECT_FALSE(path_inside("out", std::string(256, 'a')).ok());
}

}  // namespace
}  // namespace skinframe::client
