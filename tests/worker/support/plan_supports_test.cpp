// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/support/plan_supports.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "tests/worker/support/small_prints.h"

namespace skinframe {
namespace {

using test::bridges_10_mm;
using test::hall;
using test::table_top;
using On = SupportNode::On;

SupportPlan plan_of(const Frame& frame, const PrintedBody& body, SupportOptions options = {}) {
  auto plan = plan_supports(frame, bridges_10_mm(), body, options, RunContext{});
  EXPECT_TRUE(plan.ok());
  return plan.ok() ? *plan : SupportPlan{};
}

// Two posts of 20 mm and a beam of 25 mm on top of them.
Frame portal() {
  Frame frame;
  frame.nodes_mm = {{0, 0, 0}, {0, 0, 20}, {25, 0, 20}, {25, 0, 0}};
  frame.struts = {{0, 1, false}, {1, 2, false}, {2, 3, false}};
  return frame;
}

// Whether the rule holds: no piece is too long, and each node that an upper end of a support stands for has a
// way down. Written anew, by search.
bool rule_holds(const Frame& frame, const SupportPlan& plan, const PrintedBody& body, double plate_reach) {
  const PrintableLength curve = bridges_10_mm();
  const int own = static_cast<int>(frame.nodes_mm.size()), count = own + static_cast<int>(plan.nodes.size());
  std::vector<bool> led_down(count, false);
  for (const SupportStrut& s : plan.struts) {
    const auto &a = node_mm(frame, plan, s.upper), &b = node_mm(frame, plan, s.lower);
    if (!(b.z() < a.z()) || !prints(curve, a, b) || angle_from_vertical(a, b) > 45.001 * M_PI / 180)
      return false;
    led_down[s.upper] = true;
  }
  for (int i = own; i < count; ++i) {
    const SupportNode& node = plan.nodes[i - own];
    led_down[i] = led_down[i] || node.on == On::kSkin || node.on == On::kPlate ||
                  node.at_mm.z() <= plate_reach || !footing_below(body, node.at_mm);
  }
  for (const auto& nodes : divided_struts(frame, plan))
    for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
      if (!prints(curve, node_mm(frame, plan, nodes[k]), node_mm(frame, plan, nodes[k + 1]))) return false;
      for (const auto& [node, other] : {std::pair{nodes[k], nodes[k + 1]}, std::pair{nodes[k + 1], nodes[k]}})
        if (node < own && frame.nodes_mm[node].z() > node_mm(frame, plan, other).z()) led_down[node] = true;
    }
  for (int i = 0; i < count; ++i)
    if (!led_down[i] && node_mm(frame, plan, i).z() > plate_reach) return false;
  return true;
}

TEST(PlanSupports, AStrutThatPrintsGetsNone) {
  Frame frame = portal();
  frame.nodes_mm[2].x() = frame.nodes_mm[3].x() = 10.0;  // exactly p
  const SupportPlan plan = plan_of(frame, hall());
  EXPECT_TRUE(plan.nodes.empty());
  EXPECT_TRUE(plan.struts.empty());
}

TEST(PlanSupports, ABeamIsDividedIntoEqualPrintablePieces) {
  const SupportPlan plan = plan_of(portal(), hall());
  ASSERT_GE(plan.nodes.size(), 2u);
  EXPECT_TRUE(plan.nodes[0].at_mm.isApprox(Eigen::Vector3d(25.0 / 3, 0, 20)));
  EXPECT_TRUE(plan.nodes[1].at_mm.isApprox(Eigen::Vector3d(50.0 / 3, 0, 20)));
  EXPECT_EQ(plan.nodes[0].strut, 1);
  EXPECT_THAT(divided_struts(portal(), plan)[1], testing::ElementsAre(1, 4, 5, 2));
}

TEST(PlanSupports, TheSecondSupportOfABeamBranchesOffTheFirst) {
  const SupportPlan plan = plan_of(portal(), hall());
  // One upright to the floor, divided where the other one, at 45 degrees or steeper, ends on it.
  ASSERT_EQ(plan.struts.size(), 3u);
  ASSERT_EQ(plan.nodes.size(), 4u);
  EXPECT_EQ(plan.nodes[2].on, On::kSkin);
  EXPECT_LE(plan.nodes[2].at_mm.z(), 0.5);
  EXPECT_EQ(plan.nodes[3].on, On::kSupport);
  EXPECT_NEAR(plan.nodes[3].at_mm.z(), 20 - 25.0 / 3, 1.5);
  for (const SupportStrut& s : plan.struts) EXPECT_EQ(s.kind, SupportKind::kInternal);
}

TEST(PlanSupports, ANodeThatNoStrutLeadsDownFromIsHeld) {
  Frame frame;
  frame.nodes_mm = {{0, 0, 30}, {0, 0, 20}, {0, 0, 1.0}};
  frame.struts = {{0, 1, false}};
  const SupportPlan plan = plan_of(frame, hall());
  ASSERT_EQ(plan.struts.size(), 1u);
  EXPECT_EQ(plan.struts[0].upper, 1);
  EXPECT_EQ(plan.struts[0].lower, 2) << "the node below is nearer than the floor";
}

TEST(PlanSupports, BelowTheBodyStrutsStandOnThePlateOutside) {
  Frame frame;
  frame.nodes_mm = {{0, 0, 31}, {18, 0, 31}};
  frame.struts = {{0, 1, false}};
  const SupportPlan plan = plan_of(frame, table_top());
  ASSERT_FALSE(plan.struts.empty());
  int on_plate = 0;
  for (const SupportStrut& s : plan.struts) EXPECT_EQ(s.kind, SupportKind::kExternal);
  for (const SupportNode& node : plan.nodes) {
    EXPECT_NE(node.on, On::kSkin);
    if (node.on != On::kPlate) continue;
    ++on_plate;
    EXPECT_EQ(node.at_mm.z(), 0.0);
  }
  EXPECT_EQ(on_plate, 1) << "the others branch off";
  EXPECT_TRUE(rule_holds(frame, plan, table_top(), 1.0));
}

TEST(PlanSupports, ASteepWallHoldsWhatIsInIt) {
  Frame frame = portal();
  PrintedBody wall = hall();
  wall.depth_mm = [](const Eigen::Vector3d& p) { return p.y() + 1.0; };
  wall.outward = [](const Eigen::Vector3d&) { return Eigen::Vector3d(0, -1, 0); };
  const SupportPlan plan = plan_of(frame, wall);
  EXPECT_TRUE(plan.struts.empty());
  EXPECT_EQ(plan.held_by_wall, 2);
}

TEST(PlanSupports, TheLowerEdgeOfAThinWallIsHeldThoughTheWallIsSteep) {
  // A fin 1 mm thick that ends 30 mm above the base plane.
  PrintedBody fin = table_top();
  fin.depth_mm = [](const Eigen::Vector3d& p) { return std::min(0.5 - std::abs(p.x()), p.z() - 30.0); };
  fin.outward = [](const Eigen::Vector3d& p) { return Eigen::Vector3d(p.x() < 0 ? -1 : 1, 0, 0); };
  Frame frame;
  frame.nodes_mm = {{0.1, 0, 33}, {0.1, 0, 38}};
  frame.struts = {{0, 1, false}};
  ASSERT_TRUE(is_in_steep_wall(fin, {0.1, 0, 30.5}, 45 * M_PI / 180));
  EXPECT_TRUE(plan_of(frame, fin).struts.empty()) << "higher up the wall holds its nodes";
  SupportOptions options;
  options.roof_points = {{0.1, 0, 30.5}};
  const SupportPlan plan = plan_of(frame, fin, options);
  ASSERT_EQ(plan.struts.size(), 1u);
  EXPECT_EQ(plan.struts[0].kind, SupportKind::kExternal);
  EXPECT_EQ(plan.nodes[plan.struts[0].lower - 2].on, On::kPlate);
}

TEST(PlanSupports, ThePlateHoldsWhatLiesOnIt) {
  Frame frame;
  frame.nodes_mm = {{0, 0, 0.8}, {40, 0, 0.8}};
  frame.struts = {{0, 1, true}};
  const SupportPlan plan = plan_of(frame, hall());
  EXPECT_TRUE(plan.struts.empty());
  EXPECT_EQ(plan.held_by_plate, 3);
}

TEST(PlanSupports, NoInternalStrutPassesThroughTheSkin) {
  // A hall with a wall of 1 mm at x = 8: the nearest node below stands behind it.
  PrintedBody body = hall();
  body.depth_mm = [](const Eigen::Vector3d& p) { return std::min(p.z(), std::abs(p.x() - 8.0) - 0.5); };
  Frame frame;
  frame.nodes_mm = {{0, 0, 30}, {0, 0, 50}, {12, 0, 16}, {12, 0, 0}};
  frame.struts = {{0, 1, false}, {2, 3, false}};
  const SupportPlan plan = plan_of(frame, body);
  ASSERT_EQ(plan.struts.size(), 1u);
  EXPECT_NE(plan.struts[0].lower, 2);
  body.depth_mm = hall().depth_mm;
  EXPECT_EQ(plan_of(frame, body).struts.at(0).lower, 2) << "without the wall it is taken";
}

TEST(PlanSupports, AnUprightLongerThanItsPrintableLengthIsDividedToo) {
  auto curve = PrintableLength::make({{0, 8.0}, {90, 4.0}}, false, "made up");
  ASSERT_TRUE(curve.ok());
  Frame frame;
  frame.nodes_mm = {{0, 0, 30}, {0, 0, 35}};
  frame.struts = {{0, 1, false}};
  auto plan = plan_supports(frame, *curve, hall(), {}, RunContext{});
  ASSERT_TRUE(plan.ok());
  EXPECT_EQ(plan->struts.size(), 4u) << "29.5 mm of upright in pieces of 8 mm at most";
  for (const SupportStrut& s : plan->struts)
    EXPECT_LE((node_mm(frame, *plan, s.upper) - node_mm(frame, *plan, s.lower)).norm(), 8.0 + 1e-9);
}

TEST(PlanSupports, SlenderSupportsAreThicker) {
  SupportOptions options;
  options.slenderness = 10.0;
  const SupportPlan plan = plan_of(portal(), hall(), options);
  EXPECT_NEAR(plan.struts.at(0).radius_mm, 19.5 / 10, 0.05);
}

TEST(PlanSupports, TooManyNodesAreRefused) {
  Frame frame = portal();
  frame.nodes_mm[2].x() = frame.nodes_mm[3].x() = 5000.0;
  SupportOptions options;
  options.most_nodes = 100;
  auto plan = plan_supports(frame, bridges_10_mm(), hall(), options, RunContext{});
  ASSERT_FALSE(plan.ok());
  EXPECT_EQ(plan.error().kind, ErrorKind::kInvalidInput);
}

class RandomFrames : public testing::TestWithParam<int> {};

TEST_P(RandomFrames, KeepTheRuleAndLoseItWithAnyOneSupport) {
  std::mt19937 random(GetParam());
  std::uniform_real_distribution<double> place(-40, 40), height(10, 60);
  Frame frame;
  for (int i = 0; i < 40; ++i) frame.nodes_mm.emplace_back(place(random), place(random), height(random));
  for (int i = 0; i < 40; ++i)
    for (int j = i + 1; j < 40; ++j)
      if ((frame.nodes_mm[i] - frame.nodes_mm[j]).norm() < 30) frame.struts.push_back({i, j, false});
  const SupportPlan plan = plan_of(frame, hall());
  ASSERT_FALSE(plan.struts.empty());
  EXPECT_TRUE(rule_holds(frame, plan, hall(), 1.0));
  for (std::size_t k = 0; k < plan.struts.size(); ++k) {
    SupportPlan less = plan;
    less.struts.erase(less.struts.begin() + static_cast<std::ptrdiff_t>(k));
    EXPECT_FALSE(rule_holds(frame, less, hall(), 1.0)) << "support " << k << " is useless";
  }
  const SupportPlan again = plan_of(frame, hall());
  ASSERT_EQ(again.struts.size(), plan.struts.size());
  for (std::size_t k = 0; k < plan.struts.size(); ++k) EXPECT_EQ(again.struts[k].lower, plan.struts[k].lower);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomFrames, testing::Range(1, 4));

}  // namespace
}  // namespace skinframe
