// SPDX-License-Identifier: GPL-3.0-or-later
// Chains that hang under their own weight, in closed form. gamma = 1586 MPa.
#include <gtest/gtest.h>

#include <numbers>

#include "tests/worker/mechanics/small_frames.h"
#include "worker/optimize/optimize_frame.h"

namespace skinframe {
namespace {

using Eigen::Vector3d;
using testing::bare_problem;
using testing::load_at;

constexpr double kModulus = 1586;

// From the origin down, n struts of one length, with gravity and a force at the lower end.
FrameProblem hanging_chain(int struts, double length_mm, double density_g_cm3, double force_n) {
  std::vector<Vector3d> nodes;
  std::vector<std::pair<int, int>> pairs;
  for (int i = 0; i <= struts; ++i) nodes.emplace_back(0, 0, -length_mm * i / struts);
  for (int i = 0; i < struts; ++i) pairs.emplace_back(i, i + 1);
  FrameProblem problem = bare_problem(nodes, pairs);
  problem.material.density_g_cm3 = density_g_cm3;
  problem.fixed[0] = {true, true, true};
  problem.load_cases = {load_at(problem, struts, {0, 0, -force_n}, true)};
  return problem;
}

// A uniform bar lengthens by w L^2 / (2 gamma) under its own weight w a volume, whatever its area. Half of
// each strut's weight at either end gives exactly that, for any number of struts.
TEST(HangingChain, UniformBarLengthensByItsWeightWhateverItsArea) {
  for (const int struts : {1, 2, 7, 50}) {
    const FrameProblem problem = hanging_chain(struts, 100, 400, 0);
    const double wanted = problem.material.weight_density_n_mm3() * 100 * 100 / (2 * kModulus);
    for (const double area : {0.8, 20.0}) {
      const CaseResponse r = solve_equilibrium(problem, std::vector<double>(struts, area))[0];
      EXPECT_NEAR(r.max_displacement_mm, wanted, 1e-10 * wanted) << struts << " struts of " << area;
      EXPECT_NEAR(r.displacements_mm[struts].z(), -wanted, 1e-10 * wanted);
    }
  }
}

// No area helps when the bar's own weight alone lengthens it beyond the limit.
TEST(HangingChain, WeightBeyondTheLimitIsInfeasibleAtAnyArea) {
  FrameProblem problem = hanging_chain(3, 100, 400, 0);
  const double own = problem.material.weight_density_n_mm3() * 100 * 100 / (2 * kModulus);
  problem.displacement_limit_mm = 0.9 * own;
  OptimizeOptions options;
  options.relaxed = options.topology = options.geometry = false;
  RunContext context;
  // The middle struts may be thinner than the upper one, which lessens the pull: the bounds leave no room for
  // that.
  for (RadiusBounds& bounds : problem.bounds) bounds = {1.0, 1.0};
  const auto result = optimize_frame(problem, options, context);
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(result->reason, Termination::kInfeasible);
  EXPECT_EQ(result->violated_constraint, "displacement");
}

// Two struts of length l, weight w a volume, a force P at the end. With q = w l and c = gamma epsilon / l - q
// the limit reads P / A1 + q A2 / A1 + P / A2 = c; the least A1 + A2 is at A2 = 2 P / c, A1 = 2 P (c + 2 q) /
// c^2: the upper strut is thicker, because it carries the lower one.
TEST(HangingChain, TwoStrutsWithWeightReachTheirOptimum) {
  FrameProblem problem = hanging_chain(2, 100, 400, 6);
  problem.displacement_limit_mm = 0.05;
  OptimizeOptions options;
  options.relaxed = options.topology = options.geometry = false;
  options.kkt_tolerance = 1e-8;
  RunContext context;
  const auto result = optimize_frame(problem, options, context);
  ASSERT_TRUE(result.ok());
  ASSERT_EQ(result->reason, Termination::kOptimal) << result->detail;

  const double l = 50, q = problem.material.weight_density_n_mm3() * l, c = kModulus * 0.05 / l - q;
  const double lower = 2 * 6 / c, upper = 2 * 6 * (c + 2 * q) / (c * c);
  ASSERT_GT(upper, 1.2 * lower) << "the weight counts";
  EXPECT_NEAR(result->size.volume_mm3, l * (lower + upper), 1e-6 * l * (lower + upper));
  EXPECT_NEAR(std::numbers::pi * result->radii_mm[0] * result->radii_mm[0], upper, 1e-3 * upper);
  EXPECT_NEAR(std::numbers::pi * result->radii_mm[1] * result->radii_mm[1], lower, 1e-3 * lower);
}

}  // namespace
}  // namespace skinframe
