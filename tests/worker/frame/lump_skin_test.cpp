// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/frame/lump_skin.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace skinframe {
namespace {

// A right-angled tetrahedron with legs 1 and one internal node: three faces of area 1/2, one of sqrt(3)/2.
Frame tetrahedron() {
  Frame frame;
  frame.nodes_mm = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.2, 0.2, 0.2}};
  frame.skin_node_count = 4;
  frame.skin_triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return frame;
}

TEST(LumpSkin, SharesByAreaAndSumsToTheSkin) {
  Skin skin;
  skin.volume_mm3 = 12.0;
  const auto share = lump_skin_volume_mm3(tetrahedron(), skin);
  ASSERT_EQ(share.size(), 5u);
  EXPECT_NEAR(std::accumulate(share.begin(), share.end(), 0.0), 12.0, 1e-12);
  const double area = 1.5 + std::sqrt(3.0) / 2.0;
  EXPECT_NEAR(share[0], 12.0 * 0.5 / area, 1e-12);  // a third of three faces of 1/2
  EXPECT_NEAR(share[1], 12.0 * (1.0 + std::sqrt(3.0) / 2.0) / 3.0 / area, 1e-12);
  EXPECT_EQ(share[4], 0.0);
}

TEST(LumpSkin, FrameWithoutTrianglesCarriesNothing) {
  Skin skin;
  skin.volume_mm3 = 12.0;
  Frame frame;
  frame.nodes_mm = {{0, 0, 0}};
  EXPECT_EQ(lump_skin_volume_mm3(frame, skin), std::vector<double>{0.0});
}

}  // namespace
}  // namespace skinframe
