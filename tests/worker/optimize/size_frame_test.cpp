// SPDX-License-Identifier: GPL-3.0-or-later
// SizeOpt on problems whose optimum is worked out by hand. gamma = 1586 MPa, mu = 1387 MPa.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/worker/mechanics/small_frames.h"
#include "tests/worker/optimize/test_frames.h"
#include "worker/optimize/optimize_frame.h"

namespace skinframe {
namespace {

using std::numbers::pi;
using testing::bare_problem;
using testing::chain;
using testing::load_at;
using testing::size_only;
using testing::ten_bar_truss;
using testing::two_strut_truss;

double area(double radius) { return pi * radius * radius; }

// u = F l / (2 gamma A sin^2) = epsilon.
TEST(SizeOpt, TwoStrutTrussIsAsThickAsTheDisplacementAsks) {
  FrameProblem problem = two_strut_truss(30, 40);
  problem.displacement_limit_mm = 0.05;
  problem.load_cases = {load_at(problem, 2, {0, 0, -20})};
  const OptimizeResult r = size_only(problem);
  const double wanted = 20 * 50 / (2 * 1586 * 0.05 * 0.64);
  EXPECT_EQ(r.reason, Termination::kOptimal);
  EXPECT_NEAR(area(r.radii_mm[0]), wanted, 1e-5 * wanted);
  EXPECT_NEAR(r.size.volume_mm3, 2 * wanted * 50, 1e-5 * 100 * wanted);
}

// No displacement limit, sigma = 5 MPa: A = F / (2 sin sigma).
TEST(SizeOpt, TwoStrutTrussIsAsThickAsTheStressAsks) {
  FrameProblem problem = two_strut_truss(30, 40);
  problem.material.tensile_strength_mpa = 5;
  problem.load_cases = {load_at(problem, 2, {0, 0, -200})};
  const OptimizeResult r = size_only(problem);
  EXPECT_EQ(r.reason, Termination::kOptimal);
  EXPECT_NEAR(area(r.radii_mm[0]), 200 / (2 * 0.8 * 5), 1e-4);
  EXPECT_NEAR(r.evaluation.max_axial_ratio, 1, 1e-5);
}

// A chain pulled at its end: u = F sum l_j / (gamma A_j); the optimum is uniform, A = F L / (gamma epsilon).
TEST(SizeOpt, PulledChainIsUniform) {
  FrameProblem problem =
      bare_problem({{0, 0, 0}, {20, 0, 0}, {70, 0, 0}, {100, 0, 0}}, {{0, 1}, {1, 2}, {2, 3}});
  problem.fixed[0] = {true, true, true};
  problem.displacement_limit_mm = 0.05;
  problem.load_cases = {load_at(problem, 3, {8, 0, 0})};
  const OptimizeResult r = size_only(problem);
  const double wanted = 8 * 100 / (1586 * 0.05);
  for (double radius : r.radii_mm) EXPECT_NEAR(area(radius), wanted, 1e-4 * wanted);
  EXPECT_NEAR(r.evaluation.max_displacement_mm, 0.05, 1e-8);
}

// The second strut sits at its upper bound A2: the first makes up for it, l1 / A1 = gamma epsilon / F - l2 /
// A2.
TEST(SizeOpt, BoundsAreKeptAndTheRestMakesUpForThem) {
  FrameProblem problem = chain(2, 100);
  problem.bounds[1] = {0.5, 1.6};
  problem.displacement_limit_mm = 0.05;
  problem.load_cases = {load_at(problem, 2, {8, 0, 0})};
  const OptimizeResult r = size_only(problem);
  const double upper = area(1.6), first = 50 / (1586 * 0.05 / 8 - 50 / upper);
  EXPECT_NEAR(area(r.radii_mm[1]), upper, 1e-4 * upper);
  EXPECT_NEAR(area(r.radii_mm[0]), first, 1e-3 * first);
}

// Each case alone wants one strut thick. Case x on strut 0 (along x), case z on strut 1 (along z),
// pin-jointed.
TEST(SizeOpt, EveryLoadCaseIsServedThoughOnlyOneIsCritical) {
  FrameProblem problem = bare_problem({{50, 0, 0}, {0, 0, 50}, {0, 0, 0}}, {{0, 2}, {1, 2}});
  problem.element = ElementModel::kAxial;
  problem.fixed[0] = problem.fixed[1] = {true, true, true};
  problem.fixed[2] = {false, true, false};
  problem.displacement_limit_mm = 0.05;
  problem.load_cases = {load_at(problem, 2, {10, 0, 0}), load_at(problem, 2, {0, 0, 6})};
  const OptimizeResult r = size_only(problem);
  EXPECT_NEAR(area(r.radii_mm[0]), 10 * 50 / (1586 * 0.05), 1e-4);
  EXPECT_NEAR(area(r.radii_mm[1]), 6 * 50 / (1586 * 0.05), 1e-4);
}

// Both cases are out of reach, the second a little less: at the upper bounds both are as near as they come.
TEST(SizeOpt, LessCriticalLoadCaseCountsWhenNothingIsFeasible) {
  FrameProblem problem = bare_problem({{50, 0, 0}, {0, 0, 50}, {0, 0, 0}}, {{0, 2}, {1, 2}});
  problem.element = ElementModel::kAxial;
  problem.fixed[0] = problem.fixed[1] = {true, true, true};
  problem.fixed[2] = {false, true, false};
  problem.displacement_limit_mm = 0.05;
  problem.load_cases = {load_at(problem, 2, {400, 0, 0}), load_at(problem, 2, {0, 0, 390})};
  const OptimizeResult r = size_only(problem);
  EXPECT_EQ(r.reason, Termination::kInfeasible);
  ASSERT_TRUE(r.best_reachable_displacement_mm.has_value());
  EXPECT_NEAR(*r.best_reachable_displacement_mm, 400 * 50 / (1586 * area(5)), 1e-4);
}

TEST(SizeOpt, FeasibleLowerBoundsAreTheOptimumAndItsBound) {
  FrameProblem problem = chain(3, 60);
  problem.displacement_limit_mm = 0.05;
  problem.load_cases = {load_at(problem, 3, {0.01, 0, 0})};
  const OptimizeResult r = size_only(problem);
  EXPECT_EQ(r.reason, Termination::kOptimal);
  EXPECT_NEAR(r.size.volume_mm3, 60 * area(0.5), 1e-9);
  ASSERT_TRUE(r.lower_bound_mm3.has_value());
  EXPECT_NEAR(*r.lower_bound_mm3, r.size.volume_mm3, 1e-9);
  EXPECT_EQ(r.interior_point_iterations, 0);
  EXPECT_NE(r.detail.find("global optimum for the nodes and struts given"), std::string::npos) << r.detail;
}

// Even at the upper bounds u = F L / (gamma pi 25) > epsilon: that is the best that can be reached.
TEST(SizeOpt, InfeasibleLoadGivesTheBestReachableDisplacement) {
  FrameProblem problem = chain(3, 90);
  problem.displacement_limit_mm = 0.05;
  problem.load_cases = {load_at(problem, 3, {200, 0, 0})};
  const OptimizeResult r = size_only(problem);
  EXPECT_EQ(r.reason, Termination::kInfeasible);
  EXPECT_EQ(r.violated_constraint, "displacement");
  ASSERT_TRUE(r.best_reachable_displacement_mm.has_value());
  EXPECT_NEAR(*r.best_reachable_displacement_mm, 200 * 90 / (1586 * area(5)), 1e-4);
}

// A lying strut of mass rho A l at x = 10 against the skin's weight at x = 40 over a base that ends at x =
// 20: W (40 - 20) <= rho g A l (20 - 10).
TEST(SizeOpt, BalanceThickensWhatWeighsOnTheRightSide) {
  FrameProblem problem = bare_problem({{0, 0, 0}, {20, 0, 0}}, {{0, 1}});
  problem.fixed[0] = problem.fixed[1] = {true, true, true};
  problem.material.density_g_cm3 = 1e3;
  problem.skin_mass = {1.0, {40, 0, 10}};
  problem.balance = {{{1, 0}, 20}};
  problem.load_cases = {load_at(problem, 0, {0, 0, 0}, true)};
  const double wanted = 20 / (1e3 * 1e-9 * 9810 * 20 * 10);
  ASSERT_LT(wanted, area(5));
  const OptimizeResult r = size_only(problem);
  EXPECT_EQ(r.reason, Termination::kOptimal) << r.detail;
  EXPECT_NEAR(area(r.radii_mm[0]), wanted, 1e-4 * wanted);
  EXPECT_NEAR(r.evaluation.balance_margin_mm, 0, 1e-4);
}

// The same, where the strut that balances is thicker than the middle of its bounds and all but as thick as
// they allow.
TEST(SizeOpt, BalanceJustWithinReachIsReached) {
  for (double share : {0.55, 0.8, 0.95, 0.99, 0.999}) {
    FrameProblem problem = bare_problem({{0, 0, 0}, {20, 0, 0}}, {{0, 1}});
    problem.fixed[0] = problem.fixed[1] = {true, true, true};
    problem.material.density_g_cm3 = 1e3;
    const double wanted = share * area(5);
    problem.skin_mass = {wanted * 1e3 * 1e-9 * 9810 * 20 * 10 / 20, {40, 0, 10}};
    problem.balance = {{{1, 0}, 20}};
    problem.load_cases = {load_at(problem, 0, {0, 0, 0}, true)};
    const OptimizeResult r = size_only(problem);
    EXPECT_EQ(r.reason, Termination::kOptimal) << share << ": " << r.detail;
    EXPECT_NEAR(area(r.radii_mm[0]), wanted, 1e-4 * wanted) << share;
  }
}

TEST(SizeOpt, BalanceOutOfReachIsNamed) {
  FrameProblem problem = bare_problem({{0, 0, 0}, {20, 0, 0}}, {{0, 1}});
  problem.fixed[0] = problem.fixed[1] = {true, true, true};
  problem.skin_mass = {1.0, {40, 0, 10}};
  problem.balance = {{{1, 0}, 20}};
  problem.load_cases = {load_at(problem, 0, {0, 0, 0}, true)};
  const OptimizeResult r = size_only(problem);
  EXPECT_EQ(r.reason, Termination::kInfeasible);
  EXPECT_EQ(r.violated_constraint, "balance");
  EXPECT_FALSE(r.best_reachable_displacement_mm.has_value())
      << "it is not the displacement that is out of reach";
  EXPECT_LT(r.evaluation.balance_margin_mm, 0);
}

TEST(SizeOpt, TenBarTrussReachesThePublishedStressOptimum) {
  const OptimizeResult r = size_only(ten_bar_truss());
  EXPECT_EQ(r.reason, Termination::kOptimal);
  EXPECT_NEAR(0.1 * r.size.volume_mm3, 1593.2, 0.05);
  EXPECT_NEAR(r.evaluation.max_axial_ratio, 1, 1e-5);
}

// The same truss in mm and N, and in another consistent system with lengths and forces a thousandfold.
TEST(SizeOpt, AnswerDoesNotDependOnTheSystemOfUnits) {
  FrameProblem small = two_strut_truss(30, 40), large = two_strut_truss(30e3, 40e3);
  small.displacement_limit_mm = 0.05;
  small.load_cases = {load_at(small, 2, {3, 0, -20})};
  large.displacement_limit_mm = 50;
  large.material.tensile_modulus_mpa /= 1e3;
  for (RadiusBounds& b : large.bounds) b = {1e3 * b.min_mm, 1e3 * b.max_mm};
  large.load_cases = {load_at(large, 2, {3e3, 0, -20e3})};
  const OptimizeResult a = size_only(small), b = size_only(large);
  ASSERT_EQ(a.reason, Termination::kOptimal);
  for (int j : {0, 1}) EXPECT_NEAR(b.radii_mm[j], 1e3 * a.radii_mm[j], 1e-3 * b.radii_mm[j]);
}

}  // namespace
}  // namespace skinframe
