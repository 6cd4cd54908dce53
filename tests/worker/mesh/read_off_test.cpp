// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include "tests/worker/mesh/mesh_files.h"

namespace skinframe {
namespace {

using ::testing::HasSubstr;
using namespace testing;

TEST(ReadOff, CommentsColoursAndNormalsAreReadOver) {
  expect_tetrahedron(read_bytes(off()), "OFF");
  expect_tetrahedron(
      read_bytes(
          "# head\nCOFF # kind\n\n4 4 0 # counts\n0 0 0 255 0 0 255\n1 0 0 1 1 1 1\n\n0 1 0 0 0 0 0\n0 0 1 "
          "0 0 0 0\n3 0 2 1 0.5 0.5 0.5\n3 0 1 3 7\n3 0 3 2\n3 1 2 3\n"),
      "OFF");
  expect_tetrahedron(read_bytes("OFF 4 4 6\n" + off().substr(10)), "OFF");
}

TEST(ReadOff, PolygonsAreCut) {
  const auto file = read_bytes("OFF\n5 1 0\n0 0 0\n2 0 0\n2 2 0\n1 1 0\n0 2 0\n5 0 1 2 3 4\n");
  ASSERT_TRUE(file.ok()) << file.error().message;
  EXPECT_NEAR(surface_area(file->mesh), 3, 1e-12);
}

TEST(ReadOff, DefectsAreNamed) {
  EXPECT_THAT(error_of("OFF\n4000000000 4 0\n0 0 0\n"), HasSubstr("4000000000 vertices"));
  EXPECT_THAT(error_of("OFF\n4 4000000000 0\n0 0 0\n"), HasSubstr("4000000000 faces"));
  EXPECT_THAT(error_of("OFF\n-4 4 0\n"), HasSubstr("line 2"));
  EXPECT_THAT(error_of("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
              HasSubstr("line 6: index 3 of 3 vertices"));
  EXPECT_THAT(error_of("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n"), HasSubstr("line 6"));
  EXPECT_THAT(error_of("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n-3 0 1 2\n"), HasSubstr("line 6"));
  EXPECT_THAT(error_of("OFF\n3 1 0\n0 0 0\n1 0 inf\n0 1 0\n3 0 1 2\n"), HasSubstr("line 4: \"inf\""));
  EXPECT_THAT(error_of("OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"), HasSubstr("after 1 of 2 faces"));
}

TEST(ReadOff, OtherVariantsAreRefusedByName) {
  EXPECT_THAT(error_of("4OFF\n1 1 0\n"), HasSubstr("\"4OFF\""));
  const auto binary = read_bytes("OFF BINARY\n");
  ASSERT_FALSE(binary.ok());
  EXPECT_EQ(binary.error().kind, ErrorKind::kUnsupported);
}

}  // namespace
}  // namespace skinframe
