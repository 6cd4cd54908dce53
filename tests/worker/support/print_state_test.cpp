// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/support/print_state.h"

#include <gtest/gtest.h>

#include "worker/support/plan_supports.h"

namespace skinframe {
namespace {

// A level strut 100 mm above the plate that rests on one upright support in its middle.
FrameProblem level_strut() {
  FrameProblem problem;
  problem.material.tensile_modulus_mpa = 2000;
  problem.material.shear_modulus_mpa = 1000;
  problem.material.density_g_cm3 = 1.2;
  problem.frame.nodes_mm = {{-10, 0, 100}, {10, 0, 100}};
  problem.frame.struts = {{0, 1, false}};
  problem.bounds = {{0.5, 5}};
  problem.fixed.assign(2, {false, false, false});
  problem.displacement_limit_mm = 0.05;
  return problem;
}
SupportPlan one_upright(double radius_mm) {
  SupportPlan plan;
  plan.nodes = {{{0, 0, 100}, SupportNode::On::kStrut, 0}, {{0, 0, 0}, SupportNode::On::kPlate, -1}};
  plan.struts = {{2, 3, SupportKind::kInternal, radius_mm}};
  return plan;
}

TEST(PrintState, AnUprightShortensByItsLoadOverItsStiffness) {
  const FrameProblem problem = level_strut();
  SupportPlan plan = one_upright(1.0);
  const PrintState state = size_supports(problem, {2.0}, 0.5, plan);
  // On the upright, of area a, rest the strut, 20 mm of area 4 a, and half of its own weight: 20 4 + 50.
  const double w = problem.material.weight_density_n_mm3();
  EXPECT_NEAR(state.worst_deformation_mm, w * (20 * 4 + 50) * 100 / 2000, 1e-9);
  EXPECT_TRUE(state.holds());
  EXPECT_EQ(plan.struts[0].radius_mm, 1.0);
}

TEST(PrintState, SupportsGrowUntilTheLimitHolds) {
  FrameProblem problem = level_strut();
  SupportPlan plan = one_upright(1.0);
  problem.displacement_limit_mm = 0.9 * size_supports(problem, {2.0}, 0.5, plan).worst_deformation_mm;
  EXPECT_TRUE(size_supports(problem, {2.0}, 0.5, plan).holds());
  EXPECT_DOUBLE_EQ(plan.struts[0].radius_mm, kGrowth);
}

TEST(PrintState, ALimitThatCannotHoldIsToldAsItIs) {
  FrameProblem problem = level_strut();
  SupportPlan plan = one_upright(1.0);
  problem.displacement_limit_mm = 1e-9;
  const PrintState state = size_supports(problem, {2.0}, 0.5, plan);
  EXPECT_FALSE(state.holds());
  EXPECT_GT(state.worst_deformation_mm, 1e-9);
}

}  // namespace
}  // namespace skinframe
