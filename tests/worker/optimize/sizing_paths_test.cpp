// SPDX-License-Identifier: GPL-3.0-or-later
// The ways through SizeOpt other than the straight one: presolve, start, search for a feasible start, load
// cases that join, repair, and every kind of infeasibility.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "tests/worker/mechanics/small_frames.h"
#include "tests/worker/optimize/test_frames.h"
#include "worker/optimize/optimize_frame.h"
#include "worker/optimize/size_frame.h"
#include "worker/optimize/uniform_start.h"

namespace skinframe {
namespace {

using std::numbers::pi;
using testing::bare_problem;
using testing::base_hull;
using testing::chain;
using testing::Egg;
using testing::load_at;
using testing::make_egg;
using testing::pulled_chain;
using testing::top_load;

double area(double radius) { return pi * radius * radius; }

SizedFrame sized(const FrameProblem& problem, const OptimizeOptions& options = {},
                 SizingEffort effort = SizingEffort::kBestReachable) {
  RunContext context;
  Session session(options, context);
  return size_frame(problem, {}, session, effort);
}

// Two struts of length l, one below the other, that carry nothing but themselves. With c = rho g l^2 / gamma
// the lower end sinks by c (1 + A2 / A1): at any one radius by 2 c, and less the thinner the lower strut.
FrameProblem hanging_pair(double sink_over_c) {
  constexpr double kLength = 100, kDensity = 1e4;
  FrameProblem problem = bare_problem({{0, 0, 2 * kLength}, {0, 0, kLength}, {0, 0, 0}}, {{0, 1}, {1, 2}});
  problem.fixed[0] = {true, true, true};
  problem.material.density_g_cm3 = kDensity;
  const double c = kDensity * 1e-9 * 9810 * kLength * kLength / 1586;
  problem.displacement_limit_mm = sink_over_c * c;
  problem.load_cases = {load_at(problem, 2, {0, 0, 0}, true)};
  return problem;
}

UniformStart uniform(const FrameProblem& problem) {
  EquilibriumSolver solver(problem);
  const AreaBox box = area_box(problem);
  return uniform_start(problem, box.lower_mm2, box.upper_mm2, solver);
}

TEST(UniformStart, IsTheSmallestFeasibleRadius) {
  const UniformStart start = uniform(pulled_chain(8));
  const double least = 8 * 90 / (1586 * 0.05);
  EXPECT_LE(start.utilisation, 1);
  for (double a : start.areas_mm2) {
    EXPECT_GE(a, least);
    EXPECT_LT(a, 1.03 * least);
  }
}

TEST(UniformStart, IsClippedToTheBoundsOfEachStrut) {
  FrameProblem problem = pulled_chain(8);
  problem.bounds[1] = {3, 4};
  const UniformStart start = uniform(problem);
  EXPECT_LE(start.utilisation, 1);
  EXPECT_NEAR(start.areas_mm2[1], area(3), 1e-12);
  EXPECT_LT(start.areas_mm2[0], area(3));
}

TEST(UniformStart, WithoutAFeasibleRadiusIsTheBestOne) {
  const UniformStart start = uniform(pulled_chain(200));
  EXPECT_NEAR(start.utilisation, 200 * 90 / (1586 * area(5)) / 0.05, 1e-6);
  EXPECT_NEAR(start.areas_mm2[0], area(5), 1e-9);
}

TEST(SizeOptPaths, FrameThatNoSingleRadiusServesIsFoundAllTheSame) {
  const FrameProblem problem = hanging_pair(1.5);
  ASSERT_GT(uniform(problem).utilisation, 1);
  const SizedFrame frame = sized(problem);
  ASSERT_EQ(frame.reason, Termination::kOptimal) << frame.detail;
  EXPECT_NEAR(frame.areas_mm2[1], area(0.5), 1e-4);
  EXPECT_NEAR(frame.areas_mm2[0], 2 * area(0.5), 1e-4);
  EXPECT_FALSE(frame.certificate.has_value());
}

// A2 / A1 >= (0.5 / 5)^2: below 1.01 c it never comes.
TEST(SizeOptPaths, BestReachableNeedNotBeAtTheUpperBounds) {
  const FrameProblem problem = hanging_pair(0.4);
  const SizedFrame frame = sized(problem);
  ASSERT_EQ(frame.reason, Termination::kInfeasible);
  EXPECT_EQ(frame.violated_constraint, "displacement");
  EXPECT_NEAR(frame.evaluation.displacement_ratio, 1.01 / 0.4, 1e-4);
  ASSERT_TRUE(frame.certificate.has_value()) << frame.detail;
  EXPECT_GT(frame.certificate->proven_ratio, 1);
  EXPECT_LE(frame.certificate->proven_ratio, frame.evaluation.displacement_ratio);
  EXPECT_NE(frame.detail.find("proven"), std::string::npos);
  EXPECT_EQ(frame.detail.find("not proven"), std::string::npos) << frame.detail;
}

TEST(SizeOptPaths, ForTheVerdictAloneTheProofIsEnough) {
  const SizedFrame frame = sized(pulled_chain(200), {}, SizingEffort::kVerdict);
  EXPECT_EQ(frame.reason, Termination::kInfeasible);
  EXPECT_TRUE(frame.certificate.has_value());
  EXPECT_EQ(frame.violated_constraint, "displacement");
}

// Two loaded nodes, each allowed its epsilon in every direction: only their sum is certified, so that a frame
// can be infeasible without a proof.
TEST(SizeOptPaths, WhatIsNotProvenIsCalledSo) {
  FrameProblem problem =
      bare_problem({{720, 0, 360}, {720, 0, 0}, {360, 0, 360}, {360, 0, 0}, {0, 0, 360}, {0, 0, 0}},
                   {{4, 2}, {2, 0}, {5, 3}, {3, 1}, {2, 3}, {0, 1}, {4, 3}, {5, 2}, {2, 1}, {3, 0}});
  problem.element = ElementModel::kAxial;
  problem.material.tensile_modulus_mpa = 1e4;
  for (RadiusBounds& b : problem.bounds) b = {std::sqrt(0.1 / pi), 3};
  for (int i = 0; i < 6; ++i) problem.fixed[i] = {i >= 4, true, i >= 4};
  problem.displacement_limit_mm = 2;
  problem.load_cases = {load_at(problem, 1, {0, 0, -100})};
  problem.load_cases[0].force_n[3] = {0, 0, -100};
  const SizedFrame best = sized(problem);
  FrameProblem barely = problem;
  // A little below what its best frame reaches when no volume counts.
  barely.displacement_limit_mm = 1e-3;
  barely.displacement_limit_mm = 0.99 * sized(barely).evaluation.max_displacement_mm;
  const SizedFrame frame = sized(barely);
  ASSERT_EQ(best.reason, Termination::kOptimal);
  ASSERT_EQ(frame.reason, Termination::kInfeasible);
  EXPECT_NE(frame.detail.find("not proven; best found"), std::string::npos) << frame.detail;
  EXPECT_FALSE(frame.certificate.has_value());
}

TEST(SizeOptPaths, LoadCasesThatJoinOneByOneEndAtTheJointOptimum) {
  FrameProblem problem = make_egg({2, 8, 8, 120, 1.0});
  problem.load_cases = {top_load(problem, "y", {0, 30, 0}), top_load(problem, "x", {28, 0, 0}),
                        top_load(problem, "small", {0, 2, 0}), top_load(problem, "down", {0, 0, -25})};
  const SizedFrame frame = sized(problem);
  ASSERT_EQ(frame.reason, Termination::kOptimal) << frame.detail;
  const OptimizeOptions options;
  RunContext context;
  Session session(options, context);
  ProgramRequest joint;
  set_size_bounds(problem, joint);
  joint.cases = {0, 1, 2, 3};
  const ProgramOutcome all = session.solve(problem, joint, uniform(problem).areas_mm2);
  ASSERT_TRUE(all.converged());
  const double volume = frame_volume_mm3(problem.frame, radii_of(all.areas_mm2));
  EXPECT_NEAR(frame.volume_mm3(), volume, 1e-5 * volume);
}

// Solved roughly, the limits are missed by more than the tolerance asks: the frame is thickened, not given
// up.
TEST(SizeOptPaths, WhatMissesTheLimitsByRoundingIsThickened) {
  OptimizeOptions rough;
  rough.kkt_tolerance = 1e-3;
  rough.feasibility_tolerance = 1e-9;
  FrameProblem problem = make_egg({2, 8, 8, 120, 1.0});
  problem.load_cases = {top_load(problem, "y", {0, 30, 0})};
  const SizedFrame frame = sized(problem, rough), exact = sized(problem);
  ASSERT_TRUE(frame.feasible()) << frame.detail;
  EXPECT_LE(utilisation(frame.evaluation), 1 + 1e-9);
  EXPECT_LT(frame.volume_mm3(), 1.01 * exact.volume_mm3());
}

TEST(SizeOptPaths, ASupportThatIsMissingIsNamed) {
  FrameProblem problem = pulled_chain(8);
  problem.fixed[0] = {false, true, true};
  const SizedFrame frame = sized(problem);
  EXPECT_EQ(frame.reason, Termination::kInfeasible);
  EXPECT_EQ(frame.violated_constraint, "equilibrium");
  EXPECT_NE(frame.detail.find("equilibrium cannot be kept"), std::string::npos) << frame.detail;
}

// Every combination ends with a verdict, and what is said of it holds.
TEST(SizeOptPaths, NoCombinationOfLoadsAndLimitsIsWithoutAnAnswer) {
  OptimizeOptions options;
  options.relaxed = options.topology = options.geometry = false;
  int optimal = 0, infeasible = 0, proven = 0;
  for (double force : {0.0, 20.0, 1000.0, 1e6})
    for (double limit : {1e-6, 0.05, std::numeric_limits<double>::infinity()})
      for (bool strengths : {false, true})
        for (double shrink : {-1.0, 5.0, 500.0}) {  // of the base that balance is asked for
          FrameProblem problem = make_egg({1, 3, 5, 60, 1.0});
          problem.load_cases = {top_load(problem, "side", {0, force, -force / 3})};
          problem.displacement_limit_mm = std::isfinite(limit) ? std::optional(limit) : std::nullopt;
          if (!strengths)
            problem.material.tensile_strength_mpa = problem.material.shear_strength_mpa = std::nullopt;
          if (shrink >= 0) problem.balance = base_hull(problem.frame, shrink);
          SCOPED_TRACE(::testing::Message() << "force " << force << " limit " << limit << " strengths "
                                            << strengths << " base shrunk by " << shrink);
          RunContext context;
          const auto r = optimize_frame(problem, options, context);
          ASSERT_TRUE(r.ok()) << r.error().message;
          const Evaluation evaluation = evaluate(problem, r->radii_mm);
          const std::string violated = violated_constraint(evaluation, 1e-5);
          if (r->reason == Termination::kInfeasible) {
            ++infeasible;
            EXPECT_NE(violated, "");
            EXPECT_NE(r->violated_constraint, "");
            EXPECT_NE(r->detail.find("cannot be kept"), std::string::npos) << r->detail;
            EXPECT_EQ(r->detail.find("not proven") == std::string::npos, r->certificate.has_value());
            proven += r->certificate.has_value();
            if (r->certificate && r->violated_constraint != "balance") {
              EXPECT_LE(r->certificate->proven_ratio, utilisation(evaluation) * (1 + 1e-6));
            }
          } else {
            ++optimal;
            EXPECT_EQ(violated, "");
            ASSERT_TRUE(r->lower_bound_mm3.has_value());
            EXPECT_LE(*r->lower_bound_mm3, r->size.volume_mm3);
            EXPECT_FALSE(r->certificate.has_value());
          }
        }
  EXPECT_GT(optimal, 8);
  EXPECT_GT(infeasible, 15);
  EXPECT_GT(proven, 3 * infeasible / 4);
}

TEST(SizeOptPaths, ADisplacementLimitOfZeroIsRefusedByName) {
  FrameProblem problem = pulled_chain(8);
  problem.displacement_limit_mm = 0;
  RunContext context;
  const auto r = optimize_frame(problem, {}, context);
  ASSERT_FALSE(r.ok());
  EXPECT_NE(r.error().message.find("displacement_limit_mm"), std::string::npos);
}

TEST(OptimizeFrameBounds, EveryResultLiesBetweenItsBoundsAndTheirGaps) {
  FrameProblem problem = make_egg(Egg{});
  problem.load_cases = {top_load(problem, "side", {0, 20, 0})};
  RunContext context;
  const auto r = optimize_frame(problem, {}, context);
  ASSERT_TRUE(r.ok());
  ASSERT_TRUE(r->lower_bound_mm3 && r->gap && r->relaxed_lower_bound_mm3 && r->relaxed_gap);
  EXPECT_LE(*r->lower_bound_mm3, r->size.volume_mm3);
  EXPECT_NEAR(r->size.volume_mm3, *r->lower_bound_mm3 * (1 + *r->gap), 1e-9 * r->size.volume_mm3);
  EXPECT_LT(*r->gap, 0.1);
  EXPECT_LE(*r->relaxed_lower_bound_mm3, r->topology.volume_mm3);
  EXPECT_LE(*r->relaxed_lower_bound_mm3, *r->lower_bound_mm3);
  EXPECT_NEAR(r->topology.volume_mm3, *r->relaxed_lower_bound_mm3 * (1 + *r->relaxed_gap),
              1e-9 * r->topology.volume_mm3);
  EXPECT_GE(dual_value(problem, area_box(problem), *r->lower_bound_proof).value, *r->lower_bound_mm3);
}

TEST(OptimizeFrameBounds, AreLeftOutWhenTheyAreNotAskedFor) {
  FrameProblem problem = chain(3, 90);
  problem.displacement_limit_mm = 0.05;
  problem.load_cases = {load_at(problem, 3, {8, 0, 0})};
  OptimizeOptions options;
  options.bounds = false;
  RunContext context;
  const auto r = optimize_frame(problem, options, context);
  ASSERT_TRUE(r.ok());
  EXPECT_FALSE(r->lower_bound_mm3 || r->gap || r->relaxed_lower_bound_mm3 || r->lower_bound_proof);
}

}  // namespace
}  // namespace skinframe
