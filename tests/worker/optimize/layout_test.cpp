// SPDX-License-Identifier: GPL-3.0-or-later
// Pin-jointed frames whose optimal layout is known: the whole of Algorithm 1 on textbook trusses.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/worker/mechanics/small_frames.h"
#include "tests/worker/optimize/test_frames.h"
#include "worker/optimize/optimize_frame.h"

namespace skinframe {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;
using testing::bare_problem;
using testing::load_at;
using testing::ten_bar_truss;

OptimizeResult laid_out(const FrameProblem& problem,
                        OptimizeOptions::Order order = OptimizeOptions::Order::kTight) {
  OptimizeOptions options;
  options.order = order;
  RunContext context;
  auto result = optimize_frame(problem, options, context);
  EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().message);
  return std::move(result).value();
}

// With struts that may go: areas 8, 8, 4 on three bars of 360 in and 4 sqrt 2 on three diagonals, 15840 in3.
TEST(Layout, TenBarTrussKeepsTheSixBarsOfItsPlasticOptimum) {
  const OptimizeResult r = laid_out(ten_bar_truss());
  EXPECT_EQ(r.reason, Termination::kOptimal) << r.detail;
  EXPECT_NEAR(0.1 * r.size.volume_mm3, 1593.2, 0.05);
  EXPECT_NEAR(0.1 * r.geometry.volume_mm3, 1584.0, 0.05);
  EXPECT_EQ(r.geometry.struts, 6);
}

constexpr double kArm = 40, kForce = 100, kStrength = 10;
// Michell: a force at distance L from a wall that can be held anywhere needs 2 P L / sigma, and two bars at
// 45 degrees attain it.
constexpr double kMichell = 2 * kForce * kArm / kStrength;

// A ground structure between wall nodes at the heights given and a load at (arm, 0, 0), by way of free nodes
// off the diagonals. Every strut may vanish; only stress is limited.
FrameProblem cantilever(const std::vector<double>& wall_heights) {
  std::vector<Vector3d> nodes{{kArm, 0, 0}};
  for (double z : wall_heights) nodes.emplace_back(0, 0, z);
  const int walls = static_cast<int>(wall_heights.size());
  for (double z : {-31.0, -11.0, 11.0, 31.0}) nodes.emplace_back(kArm / 2, 0, z);
  std::vector<std::pair<int, int>> struts;
  for (int a = 0; a < static_cast<int>(nodes.size()); ++a)
    for (int b = a + 1; b < static_cast<int>(nodes.size()); ++b)
      if (a == 0 || b > walls) struts.emplace_back(a, b);
  FrameProblem problem = bare_problem(nodes, struts);
  problem.element = ElementModel::kAxial;
  problem.material.tensile_strength_mpa = kStrength;
  for (RadiusBounds& b : problem.bounds) b = {0, 5};
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const bool wall = nodes[i].x() == 0;
    problem.fixed[i] = {wall, true, wall};
  }
  problem.load_cases = {load_at(problem, 0, {0, 0, -kForce})};
  return problem;
}

TEST(Layout, CantileverBecomesTheTwoBarsOfMichell) {
  const OptimizeResult r = laid_out(cantilever({-60, -40, -20, 0, 20, 40, 60}));
  EXPECT_EQ(r.reason, Termination::kOptimal) << r.detail;
  EXPECT_NEAR(r.geometry.volume_mm3, kMichell, 1e-4 * kMichell);
  EXPECT_EQ(r.geometry.struts, 2);
  EXPECT_EQ(r.geometry.nodes, 3);
}

TEST(Layout, NoCantileverIsLighterThanMichells) {
  for (const auto& walls : {std::vector<double>{-50, 50}, {-30, 45}, {-40, 20}, {-25, -5, 25}})
    for (auto order : {OptimizeOptions::Order::kTight, OptimizeOptions::Order::kPaper}) {
      const OptimizeResult r = laid_out(cantilever(walls), order);
      EXPECT_EQ(r.reason, Termination::kOptimal) << r.detail;
      EXPECT_GE(r.geometry.volume_mm3, (1 - 1e-6) * kMichell);
      EXPECT_LE(r.evaluation.max_axial_ratio, 1 + 1e-5);
    }
}

}  // namespace
}  // namespace skinframe
