// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/solid/place.h"

#include <gtest/gtest.h>

#include "tests/worker/solid/shapes.h"

namespace skinframe {
namespace {

using namespace testing;

TEST(Place, TheLargestEdgeGetsTheSizeAndProportionsStay) {
  const TriangleMesh mesh = scale_to_largest_edge(box({-1, 2, 3}, {1, 7, 4}), 200);
  EXPECT_NEAR((bounding_box(mesh).extent() - Eigen::Vector3d(80, 200, 40)).norm(), 0, 1e-12);
}

TEST(Place, AMeshWithoutExtentStays) {
  EXPECT_EQ(scale_to_largest_edge({{{1, 2, 3}}, {}}, 200).vertices[0], Eigen::Vector3d(1, 2, 3));
}

TEST(Place, TurningUpIsAProperRotationThatTakesTheAxisToZ) {
  const TriangleMesh axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {}};
  for (const auto& [up, axis] : {std::pair{Up::kX, 0}, {Up::kY, 1}, {Up::kZ, 2}}) {
    const TriangleMesh turned = turn_up(axes, up);
    EXPECT_EQ(turned.vertices[axis], Eigen::Vector3d::UnitZ());
    Eigen::Matrix3d rotation;
    rotation << turned.vertices[0], turned.vertices[1], turned.vertices[2];
    EXPECT_EQ(rotation.transpose() * rotation, Eigen::Matrix3d::Identity());
    EXPECT_NEAR(rotation.determinant(), 1, 1e-15);
    EXPECT_NEAR(signed_volume(turn_up(box({0, 0, 0}, {1, 2, 3}), up)), 6, 1e-12);
  }
}

TEST(Place, OnThePlateTheLowestPointIsAtZeroAndTheMiddleAtTheOrigin) {
  const BoundingBox box_on_plate = bounding_box(put_on_plate(box({10, 20, 30}, {14, 26, 31})));
  EXPECT_EQ(box_on_plate.min, Eigen::Vector3d(-2, -3, 0));
  EXPECT_EQ(box_on_plate.max, Eigen::Vector3d(2, 3, 1));
}

}  // namespace
}  // namespace skinframe
