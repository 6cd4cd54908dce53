// SPDX-License-Identifier: Apache-2.0
#include "server/app/data_folder.h"

#include <gtest/gtest.h>

#include <optional>

#include "tests/server/fixture/temporary_folder.h"

namespace skinframe::server {
namespace {

TEST(DataFolder, TwoServersCannotShareOneUntilTheFirstIsGone) {
  TemporaryFolder folder;
  auto first = DataFolder::lock(folder.path() / "data");
  ASSERT_TRUE(first.ok()) << first.status();
  const auto second = DataFolder::lock(folder.path() / "data");
  EXPECT_TRUE(absl::IsFailedPrecondition(second.status()));
  EXPECT_NE(second.status().message().find("another server"), absl::string_view::npos);
  { const DataFolder released = *std::move(first); }
  EXPECT_TRUE(DataFolder::lock(folder.path() / "data").ok());
}

TEST(DataFolder, AFileInItsPlaceIsAClearError) {
  TemporaryFolder folder;
  ASSERT_TRUE(write_file_at_once(folder.path() / "data", "a file").ok());
  EXPECT_TRUE(absl::IsPermissionDenied(DataFolder::lock(folder.path() / "data").status()));
}

TEST(WriteFileAtOnce, ReplacesWhatWasThere) {
  TemporaryFolder folder;
  ASSERT_TRUE(write_file_at_once(folder.path() / "port", "127.0.0.1:1\n").ok());
  ASSERT_TRUE(write_file_at_once(folder.path() / "port", "127.0.0.1:22\n").ok());
  EXPECT_EQ(*read_whole_file(folder.path() / "port"), "127.0.0.1:22\n");
  EXPECT_FALSE(write_file_at_once(folder.path() / "absent" / "port", "x").ok());
}

}  // namespace
}  // namespace skinframe::server
