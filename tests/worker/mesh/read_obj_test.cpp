// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <gmock/gmock.h>
#include "tests/worker/mesh/mesh_files.h"

namespace skinframe {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using namespace testing;

const std::string kCornerLines = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";

TEST(ReadObj, EveryFormOfACornerNamesTheSameVertex) {
  expect_tetrahedron(read_bytes(obj()), "OBJ");
  expect_tetrahedron(
      read_bytes(kCornerLines +
                 "vt 0 0\nvn 0 0 1\nf 1/1 3/1 2/1\nf 1//1 2//1 4//1\nf 1/1/1 4/1/1 3/1/1\nf 2 3 4\n"),
      "OBJ");
}

TEST(ReadObj, NegativeIndicesCountBackFromTheVerticesReadSoFar) {
  expect_tetrahedron(
      read_bytes("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -1 -2\nv 0 0 1\nf -4 -3 -1\nf -4 -1 -2\nf -3 -2 -1\n"),
      "OBJ");
}

TEST(ReadObj, CommentsBlankLinesGroupsAndContinuedLinesAreReadOver) {
  expect_tetrahedron(
      read_bytes("# head\n\no body\nmtllib m.mtl\n" + kCornerLines +
                 "usemtl skin\ns off\ng a b\nf 1 3 2 # first\nf 1 2 \\\n4\nf 1 4 3\nl 1 2\nf 2 3 4"),
      "OBJ");
}

TEST(ReadObj, OldMacLineEndsAndTabsAndPlusSignsAreFine) {
  std::string text = obj();
  std::replace(text.begin(), text.end(), '\n', '\r');
  expect_tetrahedron(read_bytes(text), "OBJ");
  expect_tetrahedron(
      read_bytes("v\t+0 0 0\nv +1.0e0\t0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"), "OBJ");
}

TEST(ReadObj, AConcavePolygonIsCutWithoutLeavingIt) {
  const auto file = read_bytes("v 0 0 0\nv 2 1 0\nv 0 2 0\nv 1 1 0\nf 1 2 3 4\n");
  ASSERT_TRUE(file.ok()) << file.error().message;
  EXPECT_NEAR(surface_area(file->mesh), 1, 1e-12);
  EXPECT_THAT(file->notes, ElementsAre(HasSubstr("1 polygons")));
}

TEST(ReadObj, DefectsAreNamedByLine) {
  EXPECT_THAT(error_of(kCornerLines + "f 1 2 9000\n"), HasSubstr("line 5: index 9000 of 4 vertices"));
  EXPECT_THAT(error_of(kCornerLines + "f 1 2 -5\n"), HasSubstr("line 5: index -5 of 4 vertices"));
  EXPECT_THAT(error_of(kCornerLines + "f 0 1 2\n"), HasSubstr("line 5: \"0\" is not a vertex index"));
  EXPECT_THAT(error_of(kCornerLines + "f 1 2 x\n"), HasSubstr("line 5: \"x\""));
  EXPECT_THAT(error_of("v 0 0 0\nv nan 0 0\n"), HasSubstr("line 2: \"nan\" is not a finite coordinate"));
  EXPECT_THAT(error_of("v 0 0 1e999\n"), HasSubstr("line 1"));
  EXPECT_THAT(error_of("v 0 0\n"), HasSubstr("line 1"));
}

TEST(ReadObj, AFaceBeyondTheCornerLimitIsRefused) {
  ReadLimits limits;
  limits.max_polygon_corners = 4;
  EXPECT_THAT(error_of(kCornerLines + "f 1 2 3 4 1\n", limits), HasSubstr("more than 4 corners"));
}

// Within the limit of corners an outline may still take the cube of them in steps.
TEST(ReadObj, OutlinesThatTakeTooLongToCutAreRefusedByTheLineTheyStandIn) {
  std::string comb, face = "f";
  constexpr int kTeeth = 200;
  for (int i = 0; i < kTeeth; ++i) comb += fmt::format("v {} {} 0\n", i, i % 2 * 1000 + i * 7919 % 13);
  for (int i = kTeeth; i-- > 0;) comb += fmt::format("v {} {} 0\n", i, i % 2 * 1000 + i * 7919 % 13 - 0.001);
  for (int i = 1; i <= 2 * kTeeth; ++i) face += fmt::format(" {}", i);
  ReadLimits limits;
  EXPECT_TRUE(read_bytes(comb + face + "\n", limits).ok());
  limits.max_cutting_steps = 100'000;
  EXPECT_THAT(error_of(comb + face + "\n", limits), HasSubstr("line 401: the outlines of the faces"));
  EXPECT_THAT(error_of(comb + face + "\n", limits), HasSubstr("400 corners, take too long to cut"));
}

TEST(ReadObj, VerticesWithoutFacesAreAnError) {
  EXPECT_THAT(error_of(kCornerLines), HasSubstr("holds no triangle"));
}

TEST(ReadObj, WhatIsDroppedIsNoted) {
  const auto file = read_bytes(obj() + "v 50 50 50\nf 1 2\n");
  expect_tetrahedron(file, "OBJ");
  EXPECT_THAT(file->notes,
              ElementsAre(HasSubstr("1 faces of fewer than 3"), HasSubstr("1 vertices that no triangle")));
}

}  // namespace
}  // namespace skinframe
