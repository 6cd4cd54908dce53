// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/mesh/write_stl.h"

#include <gmock/gmock.h>

#include "tests/worker/mesh/mesh_files.h"

namespace skinframe {
namespace {

using ::testing::HasSubstr;
using namespace testing;

TEST(WriteStl, WhatIsWrittenIsReadBack) {
  const TemporaryFile target("what was there before");
  ASSERT_TRUE(write_stl({kCorners, kFaces}, target.path()).ok());
  EXPECT_EQ(std::filesystem::file_size(target.path()), 84 + 4 * 50u);
  RunContext context;
  expect_tetrahedron(read_mesh(target.path(), {}, context), "STL (binary)");
}

TEST(WriteStl, AnErrorLeavesTheOldFileAndNoTemporaryOne) {
  const TemporaryFile target("what was there before");
  TriangleMesh broken{kCorners, kFaces};
  broken.triangles[2][1] = 4;
  const Status index = write_stl(broken, target.path());
  ASSERT_FALSE(index.ok());
  EXPECT_THAT(index.error().message, HasSubstr("triangle 2: index 4 of 4 vertices"));
  TriangleMesh far{kCorners, kFaces};
  far.vertices[1].x() = 1e300;
  const Status range = write_stl(far, target.path());
  ASSERT_FALSE(range.ok());
  EXPECT_THAT(range.error().message, HasSubstr("vertex 1"));
  EXPECT_EQ(std::filesystem::file_size(target.path()), 21u);
}

TEST(WriteStl, AMissingFolderIsAnIoError) {
  const Status missing = write_stl({kCorners, kFaces}, "no/such/folder/mesh.stl");
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.error().kind, ErrorKind::kIo);
  EXPECT_THAT(missing.error().message, HasSubstr("No such file or directory"));
}

TEST(WriteStl, ALargeMeshGoesOutInPieces) {
  TriangleMesh mesh{kCorners, {}};
  for (int i = 0; i < 50'000; ++i) mesh.triangles.push_back(kFaces[i % 4]);
  const TemporaryFile target("");
  ASSERT_TRUE(write_stl(mesh, target.path()).ok());
  RunContext context;
  const auto file = read_mesh(target.path(), {}, context);
  ASSERT_TRUE(file.ok()) << file.error().message;
  EXPECT_EQ(file->mesh.triangles.size(), 50'000u);
}

}  // namespace
}  // namespace skinframe
