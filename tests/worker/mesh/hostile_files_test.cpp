// SPDX-License-Identifier: GPL-3.0-or-later
// Every file is hostile until read: whatever the bytes, there is an error or a mesh that keeps its promises.
#include <gmock/gmock.h>

#include <random>

#include "tests/worker/mesh/zip_files.h"

namespace skinframe {
namespace {

using ::testing::HasSubstr;
using namespace testing;

std::vector<std::string> one_of_each_kind() {
  return {binary_stl(),
          ascii_stl(),
          obj(),
          off(),
          ascii_ply(),
          binary_ply<float>(false),
          binary_ply<double>(true),
          threemf()};
}

void expect_error_or_promises_kept(const std::string& bytes) {
  const Result<MeshFile> file = read_bytes(bytes);
  if (!file.ok()) {
    EXPECT_FALSE(file.error().message.empty());
    return;
  }
  EXPECT_FALSE(file->mesh.triangles.empty());
  for (const auto& v : file->mesh.vertices) EXPECT_TRUE(v.allFinite());
  for (const auto& t : file->mesh.triangles) {
    for (const int v : t) {
      EXPECT_GE(v, 0);
      EXPECT_LT(v, static_cast<int>(file->mesh.vertices.size()));
    }
  }
}

TEST(HostileFiles, CutAtEveryByteGivesAnErrorOrAMesh) {
  for (const std::string& whole : one_of_each_kind()) {
    for (std::size_t length = 0; length < whole.size(); ++length)
      expect_error_or_promises_kept(whole.substr(0, length));
  }
}

TEST(HostileFiles, AWholeFileLessItsLastTriangleIsNeverTakenForWhole) {
  // OBJ announces no counts, so only there a missing end cannot be known.
  const std::string ply = binary_ply<float>(false);
  for (const std::string& whole : {binary_stl(), ascii_stl(), off(), ascii_ply(), ply}) {
    EXPECT_FALSE(read_bytes(whole.substr(0, whole.size() - 30)).ok());
  }
}

TEST(HostileFiles, AnyByteChangedGivesAnErrorOrAMesh) {
  std::mt19937 random(7);
  for (const std::string& whole : one_of_each_kind()) {
    for (std::size_t place = 0; place < whole.size(); ++place) {
      std::string bytes = whole;
      bytes[place] = static_cast<char>(random());
      expect_error_or_promises_kept(bytes);
    }
  }
}

TEST(HostileFiles, NoiseIsRefused) {
  std::mt19937 random(11);
  std::string noise(4096, ' ');
  for (char& c : noise) c = static_cast<char>(random());
  EXPECT_FALSE(read_bytes(noise).ok());
  EXPECT_THAT(error_of("dear printer, please\n"), HasSubstr("neither ASCII STL, OBJ, PLY nor OFF"));
  EXPECT_THAT(error_of(std::string("\x01\x02", 2)), HasSubstr("neither STL"));
}

TEST(HostileFiles, EmptyMissingAndDirectoryAreNamed) {
  EXPECT_THAT(error_of(""), HasSubstr("empty (0 bytes)"));
  RunContext context;
  const auto missing = read_mesh("no/such/file.stl", {}, context);
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.error().kind, ErrorKind::kIo);
  EXPECT_THAT(missing.error().message, HasSubstr("no/such/file.stl"));
  const auto directory = read_mesh(std::filesystem::temp_directory_path(), {}, context);
  ASSERT_FALSE(directory.ok());
  EXPECT_EQ(directory.error().kind, ErrorKind::kIo);
}

TEST(HostileFiles, EveryLimitIsKeptByEveryFormat) {
  for (const std::string& whole : one_of_each_kind()) {
    ReadLimits few_bytes, few_vertices, few_triangles;
    few_bytes.max_file_bytes = 50;
    few_vertices.max_vertices = 3;
    few_triangles.max_triangles = 3;
    EXPECT_THAT(error_of(whole, few_bytes), HasSubstr("more than the limit of 50"));
    EXPECT_THAT(error_of(whole, few_vertices), HasSubstr("vertices are more than the limit of 3"));
    EXPECT_THAT(error_of(whole, few_triangles), HasSubstr("more than the limit of 3"));
  }
}

TEST(HostileFiles, CancellationIsObeyed) {
  std::stop_source stop;
  stop.request_stop();
  RunContext context;
  context.stop = stop.get_token();
  const auto file = read_mesh(TemporaryFile(binary_stl()).path(), {}, context);
  ASSERT_FALSE(file.ok());
  EXPECT_EQ(file.error().kind, ErrorKind::kCancelled);
}

}  // namespace
}  // namespace skinframe
