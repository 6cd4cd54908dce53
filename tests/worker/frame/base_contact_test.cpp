// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/frame/base_contact.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace skinframe {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(ChoosePins, TakesTheCornersOfARectangleAndNothingInside) {
  std::vector<Eigen::Vector3d> points;
  for (int x = 0; x <= 10; ++x) {
    for (int y = 0; y <= 5; ++y) points.emplace_back(x, y, 0);
  }
  auto pins = choose_pins(points, 2.0);
  std::sort(pins.begin(), pins.end());
  EXPECT_THAT(pins, ElementsAre(0, 5, 60, 65));
}

TEST(ChoosePins, NoneOnALine) {
  EXPECT_THAT(choose_pins({{0, 0, 0}, {1, 1, 0}, {2, 2, 0}, {5, 5, 0}}, 1.0), IsEmpty());
}

TEST(ChoosePins, ThreeOnASpotSmallerThanTheSpacing) {
  EXPECT_EQ(choose_pins({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, 20.0).size(), 3u);
}

TEST(ContactNodes, AreThoseBelowTheHeight) {
  EXPECT_THAT(contact_nodes({{0, 0, 1}, {5, 0, 1}, {0, 5, 1}, {5, 5, 9}}, 4, 2.0), ElementsAre(0, 1, 2));
}

TEST(ContactNodes, WidenUntilThreeAreNotInLine) {
  EXPECT_THAT(contact_nodes({{0, 0, 1}, {5, 0, 3}, {9, 0, 4}, {3, 5, 7}, {3, 9, 8}}, 5, 2.0),
              ElementsAre(0, 1, 2, 3));
}

TEST(ContactNodes, NeverAnInternalNode) {
  EXPECT_THAT(contact_nodes({{0, 0, 1}, {5, 0, 1}, {0, 5, 1}, {1, 1, 0}}, 3, 2.0), testing::Not(Contains(3)));
}

}  // namespace
}  // namespace skinframe
