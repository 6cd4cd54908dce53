// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include "tests/worker/mesh/mesh_files.h"

namespace skinframe {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using namespace testing;

std::string with(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST(ReadPly, EveryEncodingGivesTheSameTetrahedron) {
  expect_tetrahedron(read_bytes(ascii_ply()), "PLY");
  expect_tetrahedron(read_bytes(binary_ply<float>(false)), "PLY");
  expect_tetrahedron(read_bytes(binary_ply<double>(false)), "PLY");
  expect_tetrahedron(read_bytes(binary_ply<float>(true)), "PLY");
  expect_tetrahedron(read_bytes(binary_ply<double>(true)), "PLY");
}

TEST(ReadPly, CountsBeyondTheFileAreRefusedBeforeMemoryIsTaken) {
  EXPECT_THAT(error_of(with(ascii_ply(), "vertex 4", "vertex 4000000000")),
              AllOf(HasSubstr("4000000000"), HasSubstr("\"vertex\"")));
  EXPECT_THAT(error_of(with(binary_ply<float>(true), "face 4", "face 4000000000")), HasSubstr("4000000000"));
  EXPECT_THAT(error_of(with(ascii_ply(), "vertex 4", "vertex -4")), HasSubstr("line 4: \"-4\""));
  EXPECT_THAT(error_of(with(ascii_ply(), "vertex 4", "vertex 99999999999999999999")), HasSubstr("line 4"));
}

TEST(ReadPly, AListOfHugeLengthIsRefusedBeforeMemoryIsTaken) {
  EXPECT_THAT(error_of(with(ascii_ply(), "3 1 2 3\n", "4294967295 1 2 3\n")),
              HasSubstr("4294967295 corners are more than the limit"));
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uint uint vertex_indices\nend_header\n";
  bytes.append(12, '\0');
  bytes.append(4, '\xff');
  EXPECT_THAT(error_of(bytes), HasSubstr("4294967295 corners are more than the limit"));
  const std::string read_over = with(bytes, "vertex_indices", "marks");
  EXPECT_FALSE(read_bytes(read_over).ok());
}

TEST(ReadPly, DefectsAreNamed) {
  EXPECT_THAT(error_of(with(ascii_ply(), "3 1 2 3\n", "3 1 2 4\n")),
              HasSubstr("line 18: index 4 of 4 vertices"));
  EXPECT_THAT(error_of(with(ascii_ply(), "3 1 2 3\n", "3 1 2 -1\n")), HasSubstr("index -1 of 4 vertices"));
  EXPECT_THAT(error_of(with(ascii_ply(), "3 1 2 3\n", "3 1 2 1.5\n")),
              HasSubstr("1.5 is not a vertex index"));
  EXPECT_THAT(error_of(with(ascii_ply(), "3 1 2 3\n", "-3 1 2 3\n")), HasSubstr("-3 is not a length"));
  EXPECT_THAT(error_of(with(ascii_ply(), "0 0 1\n", "0 0 nan\n")), HasSubstr("vertex 3"));
  EXPECT_THAT(error_of(with(ascii_ply(), "property float z\n", "")), HasSubstr("no coordinate z"));
  EXPECT_THAT(error_of(with(ascii_ply(), "vertex_indices", "corners")), HasSubstr("vertex_indices"));
  EXPECT_THAT(error_of(with(ascii_ply(), "format ascii 1.0\n", "")), HasSubstr("without a format"));
  EXPECT_THAT(error_of(with(ascii_ply(), "float x", "quaternion x")), HasSubstr("\"quaternion\""));
  EXPECT_THAT(error_of("ply\nformat ascii 1.0\n"), HasSubstr("end_header"));
}

TEST(ReadPly, ABinaryNanIsNamedByItsVertex) {
  std::string bytes = binary_ply<double>(false);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::size_t body = bytes.find("end_header\n") + 11;
  std::memcpy(bytes.data() + body + 2 * 25 + 9, &nan, 8);
  EXPECT_THAT(error_of(bytes), HasSubstr("vertex 2: coordinate y is not finite"));
}

// The tetrahedron with a colour at each corner, an unused vertex first.
std::string coloured_ply(const std::string& type) {
  std::string text = with(ascii_ply(), "vertex 4", "vertex 5");
  for (const char* name : {"blue", "red", "green"})
    text = with(text, "element face", "property " + type + " " + name + "\nelement face");
  text = with(text, "end_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n",
              "end_header\n9 9 9 7 7 7\n0 0 0 3 1 2\n1 0 0 6 4 5\n0 1 0 255 0 0\n0 0 1 0 0 0\n3 1 3 2\n3 1 2 "
              "4\n3 1 4 "
              "3\n3 2 3 4\n");
  return text;
}

TEST(ReadPly, ColoursOfVerticesComeWithTheVerticesThatAreUsed) {
  const auto file = read_bytes(coloured_ply("uchar"));
  ASSERT_TRUE(file.ok());
  using Colours = std::vector<std::array<std::uint8_t, 3>>;
  EXPECT_EQ(file->vertex_colours, (Colours{{1, 2, 3}, {4, 5, 6}, {0, 0, 255}, {0, 0, 0}}));
  EXPECT_TRUE(read_bytes(coloured_ply("float"))->vertex_colours.empty());
  EXPECT_TRUE(read_bytes(binary_ply<float>(false))->vertex_colours.empty());  // red alone
  EXPECT_THAT(error_of(with(coloured_ply("uchar"), "255 0 0", "256 0 0")), HasSubstr("256 is no colour"));
}

TEST(ReadPly, CommentsComeAlongButNotWithoutEnd) {
  EXPECT_THAT(read_bytes(ascii_ply())->comments, ::testing::ElementsAre("four corners"));
  std::string many;
  for (int k = 0; k < 1000; ++k) many += "comment again\n";
  EXPECT_EQ(read_bytes(with(ascii_ply(), "comment four corners\n", many))->comments.size(), 32U);
}

TEST(ReadPly, ElementsWithoutPropertiesCostNothingHoweverMany) {
  expect_tetrahedron(read_bytes(with(ascii_ply(), "element face", "element ghost 4000000000\nelement face")),
                     "PLY");
}

TEST(ReadPly, StripsAreRefusedByName) {
  EXPECT_THAT(error_of(with(ascii_ply(), "element face 4", "element tristrips 4")), HasSubstr("strips"));
}

}  // namespace
}  // namespace skinframe
