// SPDX-License-Identifier: GPL-3.0-or-later
// The baselines that Algorithm 1 is compared with: one radius for all, and cleaning by a threshold on the
// radius.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/worker/mechanics/small_frames.h"
#include "tests/worker/optimize/test_frames.h"
#include "worker/optimize/greedy_cleaning.h"
#include "worker/optimize/uniform_frame.h"

namespace skinframe {
namespace {

using std::numbers::pi;
using testing::load_at;

BaselineFrame cleaned(const FrameProblem& problem) {
  RunContext context;
  auto frame = greedy_cleaning(problem, {}, context);
  EXPECT_TRUE(frame.ok()) << (frame.ok() ? "" : frame.error().message);
  return std::move(frame).value();
}

FrameProblem loaded_egg() {
  FrameProblem problem = testing::make_egg(testing::Egg{2, 8, 6, 120, 1.0});
  problem.load_cases = {testing::top_load(problem, "side", {0, 10, 0})};
  return problem;
}

// A chain of three struts pulled at its end: A = F L / (gamma epsilon), the optimum itself.
TEST(UniformFrame, PulledChainGetsTheAreaOfTheFormula) {
  FrameProblem problem = testing::chain(3, 90);
  problem.displacement_limit_mm = 0.05;
  problem.load_cases = {load_at(problem, 3, {8, 0, 0})};
  const auto frame = uniform_frame(problem);
  ASSERT_TRUE(frame.ok());
  EXPECT_TRUE(frame->feasible);
  const double wanted = 8 * 90 / (1586 * 0.05);
  for (double r : frame->radii_mm) EXPECT_NEAR(pi * r * r, wanted, 1e-5 * wanted);
}

TEST(UniformFrame, OutOfReachIsSaidAndNotHidden) {
  FrameProblem problem = testing::chain(3, 90);
  problem.displacement_limit_mm = 0.05;
  problem.load_cases = {load_at(problem, 3, {800, 0, 0})};
  const auto frame = uniform_frame(problem);
  ASSERT_TRUE(frame.ok());
  EXPECT_FALSE(frame->feasible);
  EXPECT_GT(frame->evaluation.displacement_ratio, 1);
}

TEST(GreedyCleaning, KeepsEveryConstraintWithFewerStrutsAndNoMoreVolume) {
  const FrameProblem problem = loaded_egg();
  const BaselineFrame frame = cleaned(problem);
  EXPECT_TRUE(frame.feasible);
  EXPECT_TRUE(validate(frame.problem).ok());
  EXPECT_LT(frame.problem.frame.struts.size(), problem.frame.struts.size());
  const auto uniform = uniform_frame(problem);
  ASSERT_TRUE(uniform.ok());
  EXPECT_LT(frame.volume_mm3(), uniform->volume_mm3());
}

TEST(GreedyCleaning, AlgorithmOneTakesNoMoreVolume) {
  const FrameProblem problem = loaded_egg();
  const BaselineFrame frame = cleaned(problem);
  RunContext context;
  const auto result = optimize_frame(problem, {}, context);
  ASSERT_TRUE(result.ok());
  EXPECT_LT(result->geometry.volume_mm3, (1 + kVolumeTie) * frame.volume_mm3());
}

TEST(GreedyCleaning, BadOptionsAreRefusedByName) {
  GreedyOptions options;
  options.radius_threshold = 0.5;
  RunContext context;
  const auto frame = greedy_cleaning(loaded_egg(), options, context);
  ASSERT_FALSE(frame.ok());
  EXPECT_NE(frame.error().message.find("radius_threshold"), std::string::npos);
}

}  // namespace
}  // namespace skinframe
