// SPDX-License-Identifier: Apache-2.0
#include "client/cli/command_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace skinframe::client {
namespace {

using testing::ElementsAre;

TEST(LocalVerbs, PassTheirWordsOn) {
  const auto verb = local_verb({"--server", "farm:7350", "sample", "hanging-ball", "--out", "b.stl"});
  ASSERT_TRUE(verb.has_value());
  EXPECT_THAT(verb->words, ElementsAre("sample", "hanging-ball", "--out", "b.stl"));
}

TEST(LocalVerbs, AJsonFromBeforeTheVerbGoesWithThem) {
  EXPECT_THAT(local_verb({"--json", "check", "dir"})->words, ElementsAre("check", "dir", "--json"));
}

TEST(LocalVerbs, AreToldFromFileNamesAndFromOtherVerbs) {
  EXPECT_FALSE(local_verb({"run", "sample"}).has_value());
  EXPECT_FALSE(local_verb({"--server", "sample"}).has_value());
  EXPECT_FALSE(local_verb({}).has_value());
}

TEST(LocalVerbs, HelpIsOurs) { EXPECT_FALSE(local_verb({"check", "--help"}).has_value()); }

}  // namespace
}  // namespace skinframe::client
