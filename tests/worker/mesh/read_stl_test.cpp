// SPDX-License-Identifier: GPL-3.0-or-later
#include <gmock/gmock.h>
#include "tests/worker/mesh/mesh_files.h"

namespace skinframe {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using namespace testing;

TEST(ReadStl, BinaryAndAsciiGiveTheSameTetrahedron) {
  expect_tetrahedron(read_bytes(binary_stl()), "STL (binary)");
  expect_tetrahedron(read_bytes(ascii_stl()), "STL (ASCII)");
}

TEST(ReadStl, ABinaryFileWhoseHeaderSaysSolidIsReadAsBinary) {
  expect_tetrahedron(read_bytes(binary_stl("solid facet normal")), "STL (binary)");
}

TEST(ReadStl, ContentDecidesNotTheName) {
  expect_tetrahedron(read_bytes(binary_stl(), {}, ".obj"), "STL (binary)");
  expect_tetrahedron(read_bytes(obj(), {}, ".stl"), "OBJ");
}

TEST(ReadStl, AsciiKeywordsMayBeUpperCaseAndLinesEndInCrLf) {
  std::string text;
  for (const char c : ascii_stl()) {
    if (c == '\n') text += '\r';
    text += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  }
  expect_tetrahedron(read_bytes(text), "STL (ASCII)");
}

TEST(ReadStl, ALyingCountIsRefusedWithCountAndBytes) {
  std::string bytes = binary_stl();
  bytes.replace(80, 4, "\xff\xff\xff\xff");
  EXPECT_THAT(error_of(bytes),
              AllOf(HasSubstr("4294967295 triangles"), HasSubstr("284 bytes"), HasSubstr("room for 4")));
  bytes.replace(80, 4, std::string("\x02\0\0\0", 4));
  EXPECT_THAT(error_of(bytes), AllOf(HasSubstr("2 triangles"), HasSubstr("284 bytes")));
}

TEST(ReadStl, ATruncatedBinaryFileIsRefusedWithBothCounts) {
  EXPECT_THAT(error_of(binary_stl().substr(0, 200)),
              AllOf(HasSubstr("4 triangles"), HasSubstr("room for 2")));
}

TEST(ReadStl, PaddingBehindTheLastTriangleIsNoted) {
  const Result<MeshFile> file = read_bytes(binary_stl() + std::string(10, '\0'));
  expect_tetrahedron(file, "STL (binary)");
  EXPECT_THAT(file->notes, ::testing::ElementsAre(HasSubstr("10 bytes")));
}

TEST(ReadStl, ANonFiniteCornerIsNamed) {
  std::string bytes = binary_stl();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(bytes.data() + 84 + 50 * 2 + 12 + 12, &nan, 4);
  EXPECT_THAT(error_of(bytes), HasSubstr("triangle 2: corner 1"));
  EXPECT_THAT(error_of("solid\nfacet normal 0 0 0\nouter loop\nvertex 0 inf 0\n"),
              HasSubstr("line 4: \"inf\""));
}

TEST(ReadStl, AsciiDefectsAreNamedByLine) {
  EXPECT_THAT(error_of("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\n"),
              HasSubstr("line 6: a facet of 2 vertices"));
  EXPECT_THAT(error_of("solid\nfacet normal 0 0 1\nvertex 0 0 0\n"), HasSubstr("line 3: a vertex outside"));
  EXPECT_THAT(error_of("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n"), HasSubstr("line 4: \"\""));
  const std::string whole = ascii_stl();
  EXPECT_THAT(error_of(whole.substr(0, whole.find("endsolid"))),
              HasSubstr("without \"endsolid\" after 4 triangles"));
}

TEST(ReadStl, NoTriangleIsAnError) {
  EXPECT_THAT(error_of("solid Empty\nendsolid Empty"), HasSubstr("no triangle"));
  EXPECT_THAT(error_of(std::string(84, '\0')), HasSubstr("no triangle"));
}

}  // namespace
}  // namespace skinframe
