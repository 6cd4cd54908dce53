// SPDX-License-Identifier: Apache-2.0
#include "client/transfer/input_kind.h"

#include <gtest/gtest.h>

#include "tests/fixture/temporary_folder.h"

namespace skinframe::client {
namespace {

class InputKindTest : public testing::Test {
 protected:
  InputKind kind(const std::string& content) { return input_kind(folder_.write("file", content)); }
  test::TemporaryFolder folder_;
};

TEST_F(InputKindTest, AJsonObjectIsAFrameProblemWhateverTheFileIsCalled) {
  EXPECT_EQ(kind("{\"mechanics\": \"paper\"}"), InputKind::kFrameProblem);
  EXPECT_EQ(kind("\xEF\xBB\xBF\n {\r\n\t\"nodes\": []"), InputKind::kFrameProblem);
  EXPECT_EQ(kind("{}"), InputKind::kFrameProblem);
  EXPECT_EQ(kind("{" + std::string(5000, ' ')), InputKind::kFrameProblem);
}

TEST_F(InputKindTest, EveryMeshFormatIsAMesh) {
  for (const char* mesh : {"solid egg\nfacet", "ply\nformat ascii 1.0", "OFF\n3 1 0", "# made by\nv 0 0 0",
                           "v 0 0 0", "", "[1, 2]", "{ a header of a binary STL"})
    EXPECT_EQ(kind(mesh), InputKind::kMesh) << mesh;
  EXPECT_EQ(kind("{\"" + std::string(78, '\0')), InputKind::kMesh)
      << "the header of a binary STL may hold anything";
}

TEST_F(InputKindTest, WhatCannotBeReadIsLeftToWhoeverReadsIt) {
  EXPECT_EQ(input_kind(folder_.path() / "none"), InputKind::kMesh);
  EXPECT_EQ(input_kind(folder_.path()), InputKind::kMesh);
}

}  // namespace
}  // namespace skinframe::client
