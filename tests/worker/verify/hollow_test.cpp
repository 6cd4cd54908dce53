// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/verify/hollow.h"

#include <gtest/gtest.h>

#include "tests/worker/fixture/skin_of.h"
#include "tests/worker/solid/shapes.h"

namespace skinframe {
namespace {

// Of a hollowed box: what is not within walls on all six sides.
double box_volume_mm3(const Eigen::Vector3d& edges, double wall_mm) {
  return edges.prod() - (edges.array() - 2 * wall_mm).prod();
}

TEST(HollowOfEqualVolume, HasTheWallOfABoxWhereverItsFacesStand) {
  const Eigen::Vector3d edges(60, 45, 24);
  const Skin skin = test::skin_of(testing::box({0, 0, 0}, edges));
  for (const double wall : {0.6, 0.8, 1.0, 1.2, 1.4, 1.7, 2.1})
    EXPECT_NEAR(equal_volume_wall_mm(skin, edges.prod(), box_volume_mm3(edges, wall)), wall, 0.03);
}

}  // namespace
}  // namespace skinframe
