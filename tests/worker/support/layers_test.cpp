// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/support/layers.h"

#include <gtest/gtest.h>

#include "tests/worker/support/small_prints.h"

namespace skinframe {
namespace {

using test::bridges_10_mm;
using On = SupportNode::On;
const BoundingBox kBox{{-10, -10, 0}, {10, 10, 40}};

// A hall with a bead of material that hangs in it at a height of 20 mm, where the test wants one.
Frame bead(double z) {
  Frame frame;
  frame.nodes_mm = {{-2, 0, z}, {2, 0, z}};
  frame.struts = {{0, 1, false}};
  return frame;
}

TEST(Layers, WhatStartsInTheAirIsAnIsland) {
  const Layers layers = find_islands(test::hall(), kBox, bead(20), {1.0}, SupportPlan{}, bridges_10_mm(), {});
  ASSERT_EQ(layers.islands.size(), 1u) << "its lowest layer";
  EXPECT_NEAR(layers.islands[0].at_mm.z(), 19.0, 0.5);
  EXPECT_LT(layers.islands[0].at_mm.head<2>().norm(), 0.6) << "its middle: there a support holds it";
  EXPECT_NEAR(layers.count, 100, 1);
}

TEST(Layers, ASupportHoldsIt) {
  SupportPlan plan;
  plan.nodes = {{{0, 0, 20}, On::kStrut, 0}, {{8, 0, 12}, On::kSupport, -1}, {{8, 0, 0.5}, On::kSkin, -1}};
  plan.struts = {{2, 3, SupportKind::kInternal, 0.6}, {3, 4, SupportKind::kInternal, 0.6}};
  EXPECT_TRUE(find_islands(test::hall(), kBox, bead(20), {1.0}, plan, bridges_10_mm(), {}).islands.empty());
  plan.struts.pop_back();
  EXPECT_EQ(find_islands(test::hall(), kBox, bead(20), {1.0}, plan, bridges_10_mm(), {}).islands.size(), 1u)
      << "without its lower half the support itself starts in the air";
}

TEST(Layers, ABodyAboveThePlateStandsOnExternalSupports) {
  const BoundingBox box{{-5, -5, 0}, {5, 5, 32}};
  Frame frame;
  frame.nodes_mm = {{0, 0, 31}, {0, 4, 31}};
  EXPECT_EQ(
      find_islands(test::table_top(), box, frame, {}, SupportPlan{}, bridges_10_mm(), {}).islands.size(), 1u);
  SupportPlan plan;
  plan.nodes = {{{0, 0, 0}, On::kPlate, -1}};
  plan.struts = {{0, 2, SupportKind::kExternal, 0.6}};
  EXPECT_TRUE(find_islands(test::table_top(), box, frame, {}, plan, bridges_10_mm(), {}).islands.empty());
}

}  // namespace
}  // namespace skinframe
