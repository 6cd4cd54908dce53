// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/skin/narrow_band.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/worker/skin/bodies.h"
#include "worker/skin/triangle_tree.h"

namespace skinframe {
namespace {

constexpr double kVoxelMm = 0.4, kOuterVoxels = 3.0, kInnerVoxels = 9.0;
// OpenVDB's own way of growing the bands errs by up to 0.4 of a voxel on these bodies, and leaves some out.
constexpr double kErrorInVoxels = 0.07;
// Beside reentrant edges OpenVDB makes the voxels next to the surface that much too deep.
constexpr double kErrorBesideEdgesInVoxels = 0.5;

openvdb::FloatGrid::Ptr band_about(const TriangleMesh& mesh) {
  openvdb::initialize();
  std::vector<openvdb::Vec3s> points;
  for (const auto& v : mesh.vertices) points.emplace_back(v.x(), v.y(), v.z());
  std::vector<openvdb::Vec3I> triangles;
  for (const auto& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  return narrow_band(points, triangles, kVoxelMm, kOuterVoxels, kInnerVoxels);
}

// Every point of the grid about the body: its distance within the bands, the band's end beyond.
void expect_distances(const TriangleMesh& mesh, double error_in_voxels = kErrorInVoxels) {
  const auto grid = band_about(mesh);
  const TriangleTree tree(mesh);
  const BoundingBox box = bounding_box(mesh);
  const Eigen::Vector3i low = (box.min / kVoxelMm).array().floor().cast<int>() - 5,
                        high = (box.max / kVoxelMm).array().ceil().cast<int>() + 5;
  const double slack = error_in_voxels * kVoxelMm;
  for (int x = low.x(); x <= high.x(); ++x)
    for (int y = low.y(); y <= high.y(); ++y)
      for (int z = low.z(); z <= high.z(); ++z) {
        const Eigen::Vector3d p = kVoxelMm * Eigen::Vector3d(x, y, z);
        const double way = tree.distance_mm(p);
        if (way < slack) continue;  // on the surface either side is right
        const bool inside = tree.is_inside(p);
        const double band = (inside ? kInnerVoxels : kOuterVoxels) * kVoxelMm;
        const double wanted = (inside ? -1.0 : 1.0) * std::min(way, band);
        const openvdb::Coord at(x, y, z);
        ASSERT_NEAR(grid->tree().getValue(at), wanted, slack) << p.transpose();
        if (std::abs(way - band) <= slack) continue;
        ASSERT_EQ(grid->tree().isValueOn(at), way < band) << p.transpose();
      }
}

TEST(NarrowBand, HasTheDistanceToTheNearestOfLargeAndSmallTriangles) {
  expect_distances(bodies::sphere(8, 2));
  expect_distances(bodies::sphere(8, 6));
  expect_distances(bodies::torus(9, 4));
}

TEST(NarrowBand, HasTheDistanceInCornersAndWhereTheBodyIsThinnerThanTheBand) {
  expect_distances(bodies::box(11.3, 9.1, 2.7));
  const auto is_filled = [](int x, int y, int) { return x == 0 || y == 0; };
  expect_distances(bodies::blocks({3, 3, 1}, {5.3, 4.7, 6.1}, is_filled), kErrorBesideEdgesInVoxels);
}

TEST(NarrowBand, OfNothingIsOutside) {
  const auto grid = band_about({});
  EXPECT_EQ(grid->activeVoxelCount(), 0u);
  EXPECT_NEAR(grid->background(), kOuterVoxels * kVoxelMm, 1e-6);
}

}  // namespace
}  // namespace skinframe
