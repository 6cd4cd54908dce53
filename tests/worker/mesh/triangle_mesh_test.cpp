// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/mesh/triangle_mesh.h"

#include "tests/worker/mesh/mesh_files.h"

namespace skinframe {
namespace {

TEST(TriangleMesh, MeasuresOfARightTetrahedron) {
  const TriangleMesh mesh{testing::kCorners, testing::kFaces};
  EXPECT_NEAR(signed_volume(mesh), 1.0 / 6, 1e-15);
  EXPECT_NEAR(surface_area(mesh), 1.5 + std::sqrt(3.0) / 2, 1e-15);
  EXPECT_NEAR((volume_centroid(mesh) - Eigen::Vector3d::Constant(0.25)).norm(), 0, 1e-15);
  EXPECT_EQ(bounding_box(mesh).extent(), Eigen::Vector3d(1, 1, 1));
}

TEST(TriangleMesh, MeasuresDoNotLoseDigitsFarFromTheOrigin) {
  TriangleMesh mesh{testing::kCorners, testing::kFaces};
  for (auto& v : mesh.vertices) v += Eigen::Vector3d::Constant(1e6);
  EXPECT_NEAR(signed_volume(mesh), 1.0 / 6, 1e-9);
  EXPECT_NEAR((volume_centroid(mesh) - Eigen::Vector3d::Constant(1e6 + 0.25)).norm(), 0, 1e-8);
}

TEST(TriangleMesh, AnEmptyMeshHasAZeroBoxAndNoVolume) {
  EXPECT_EQ(bounding_box({}).extent(), Eigen::Vector3d::Zero());
  EXPECT_EQ(signed_volume({}), 0);
  EXPECT_EQ(surface_area({}), 0);
}

TEST(TriangleMesh, UnusedVerticesAreDroppedInOrder) {
  TriangleMesh mesh{{{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {8, 8, 8}, {0, 1, 0}}, {{1, 2, 4}}};
  EXPECT_EQ(drop_unused_vertices(mesh), 2u);
  EXPECT_EQ(mesh.triangles[0], (std::array<int, 3>{0, 1, 2}));
  EXPECT_EQ(mesh.vertices[2], Eigen::Vector3d(0, 1, 0));
}

}  // namespace
}  // namespace skinframe
