// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/export/write_3mf.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/fixture/temporary_folder.h"
#include "tests/worker/skin/bodies.h"
#include "worker/mesh/read_mesh.h"

namespace skinframe {
namespace {

namespace fs = std::filesystem;

class Write3mf : public testing::Test {
 protected:
  static std::string bytes_of(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  test::TemporaryFolder scratch_;
  const fs::path& folder_ = scratch_.path();
};

TEST_F(Write3mf, ReadsBackAsTheSameMeshInMillimetres) {
  const TriangleMesh mesh = bodies::torus(24, 9);
  ASSERT_TRUE(write_3mf(mesh, {"ring", "ring.stl", "a ring"}, folder_ / "a.3mf").ok());
  RunContext context;
  const auto back = read_mesh(folder_ / "a.3mf", {}, context);
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_EQ(back->format, "3MF");
  ASSERT_EQ(back->mesh.triangles.size(), mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      ASSERT_TRUE(back->mesh.vertices[back->mesh.triangles[t][k]].cast<float>() ==
                  mesh.vertices[mesh.triangles[t][k]].cast<float>());
}

TEST_F(Write3mf, SameInputGivesTheSameBytes) {
  const TriangleMesh mesh = bodies::box(10, 20, 30);
  ASSERT_TRUE(write_3mf(mesh, {"box", "box.stl", ""}, folder_ / "a.3mf").ok());
  ASSERT_TRUE(write_3mf(mesh, {"box", "box.stl", ""}, folder_ / "b.3mf").ok());
  EXPECT_FALSE(bytes_of(folder_ / "a.3mf").empty());
  EXPECT_TRUE(bytes_of(folder_ / "a.3mf") == bytes_of(folder_ / "b.3mf"));
}

TEST_F(Write3mf, NamesWithMarkupAndControlCharactersDoNotBreakThePackage) {
  const ThreemfText text{"a<b>&\"c\"\x01\n", "<!-- --> ]]>", "\xEF\xBF\xBF&amp;"};
  ASSERT_TRUE(write_3mf(bodies::box(10, 20, 30), text, folder_ / "a.3mf").ok());
  RunContext context;
  const auto back = read_mesh(folder_ / "a.3mf", {}, context);
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_NEAR(signed_volume(back->mesh), 6000, 1e-9);
}

TEST_F(Write3mf, AFolderThatIsNotThereIsNamedAndNothingIsLeft) {
  const auto status = write_3mf(bodies::box(1, 1, 1), {}, folder_ / "absent" / "a.3mf");
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().kind, ErrorKind::kIo);
  EXPECT_NE(status.error().message.find("absent"), std::string::npos);
  EXPECT_TRUE(fs::is_empty(folder_));
}

TEST_F(Write3mf, ACoordinateThatIsNoNumberIsRefusedByItsVertex) {
  TriangleMesh mesh = bodies::box(1, 1, 1);
  mesh.vertices[3].y() = std::nan("");
  const auto status = write_3mf(mesh, {}, folder_ / "a.3mf");
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.error().message.find("vertex 3"), std::string::npos);
  EXPECT_TRUE(fs::is_empty(folder_));
}

}  // namespace
}  // namespace skinframe
