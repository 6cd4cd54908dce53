// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/mechanics/evaluation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/worker/mechanics/small_frames.h"

namespace skinframe {
namespace {

using std::numbers::pi;
using testing::bare_problem;
using testing::chain;
using testing::load_at;

TEST(Evaluation, RatiosAreDemandOverLimit) {
  FrameProblem problem = chain(2, 100);
  problem.material.tensile_strength_mpa = 10;
  problem.material.shear_strength_mpa = 4;
  problem.material.slenderness = 60;
  problem.displacement_limit_mm = 0.05;
  problem.load_cases = {load_at(problem, 2, {3, 0, 0}), load_at(problem, 2, {0, 3, 0})};
  const double r = 1.0;
  const Evaluation e = evaluate(problem, {r, r});
  EXPECT_NEAR(e.max_axial_ratio, 3 / pi / 10, 1e-9);
  EXPECT_NEAR(e.max_shear_ratio, 3 / pi / 4, 1e-9);
  EXPECT_NEAR(e.max_slenderness_ratio, 50.0 / 60, 1e-12);
  EXPECT_NEAR(e.max_displacement_mm, 300 / (1387 * pi), 1e-9);
  EXPECT_NEAR(e.displacement_ratio, e.max_displacement_mm / 0.05, 1e-12);
  EXPECT_EQ(e.worst_load_case, 1);
  EXPECT_EQ(e.worst_node, 2);
  EXPECT_NEAR(e.frame_volume_mm3, 100 * pi, 1e-9);
  EXPECT_EQ(violated_constraint(e, 1e-6), "displacement");
}

// Skin of 2 N at x = 0 and a strut from x = 0 to x = 40 of weight w: the centre stands at 20 w / (2 + w).
TEST(Evaluation, BalanceMarginIsTheDistanceToTheNearestEdge) {
  FrameProblem problem = bare_problem({{0, 0, 0}, {40, 0, 0}}, {{0, 1}});
  problem.skin_mass = {2.0, {0, 0, 5}};
  problem.material.density_g_cm3 = 1e5;
  problem.balance = {{{1, 0}, 3.0}, {{-1, 0}, 100}, {{0, 1}, 50}, {{0, -1}, 50}};
  const double weight = 1e5 * 1e-9 * 9810 * pi * 40;
  const Evaluation e = evaluate(problem, {1.0});
  EXPECT_NEAR(e.centre_of_gravity_mm.x(), 20 * weight / (2 + weight), 1e-9);
  EXPECT_NEAR(e.balance_margin_mm, 3 - e.centre_of_gravity_mm.x(), 1e-9);
  EXPECT_LT(e.balance_margin_mm, 0);
  EXPECT_EQ(violated_constraint(e, 1e-6), "balance");
}

TEST(Evaluation, NoBalanceAskedForLeavesTheMarginInfinite) {
  EXPECT_TRUE(std::isinf(evaluate(chain(1, 10), {1.0}).balance_margin_mm));
}

TEST(Evaluation, VanishedStrutIsNeitherSlenderNorStressed) {
  FrameProblem problem = bare_problem({{0, 0, 0}, {50, 0, 0}, {0, 0, 50}}, {{0, 1}, {0, 2}, {1, 2}});
  problem.material.slenderness = 60;
  problem.bounds[2] = {0, 5};
  const Evaluation e = evaluate(problem, {1, 1, 0});
  EXPECT_NEAR(e.max_slenderness_ratio, 50.0 / 60, 1e-12);
  EXPECT_EQ(e.min_radius_mm, 1);
  EXPECT_EQ(violated_constraint(e, 1e-9), "");
}

TEST(Evaluation, RadiusOutsideItsBoundsIsMeasured) {
  const FrameProblem problem = chain(2, 20);
  EXPECT_NEAR(evaluate(problem, {0.4, 1}).radius_violation_mm, 0.1, 1e-12);
  EXPECT_NEAR(evaluate(problem, {1, 5.25}).radius_violation_mm, 0.25, 1e-12);
}

TEST(AreaBounds, SlendernessWinsOverTheUpperBoundAndIsReported) {
  FrameProblem problem = chain(1, 120);
  problem.material.slenderness = 60;
  problem.bounds[0] = {0.5, 1.0};
  const AreaBounds bounds = area_bounds(problem, 0);
  EXPECT_TRUE(bounds.widened);
  EXPECT_NEAR(bounds.lower_mm2, pi * 4, 1e-12);
  EXPECT_NEAR(bounds.upper_mm2, pi * 4 * kSlenderRoom * kSlenderRoom, 1e-12);
  EXPECT_EQ(evaluate(problem, {2.0}).widened_struts, 1);
  EXPECT_LE(evaluate(problem, {2.0}).radius_violation_mm, 0);
}

}  // namespace
}  // namespace skinframe
