// SPDX-License-Identifier: GPL-3.0-or-later
// What is taken out of a frame, what comes back, and where the next program starts.
#include "worker/optimize/restore_struts.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/worker/mechanics/small_frames.h"
#include "tests/worker/optimize/test_frames.h"
#include "worker/optimize/size_frame.h"

namespace skinframe {
namespace {

// A load at the origin that two struts carry, and eight struts beside them that need not be.
FrameProblem crowded_truss() {
  std::vector<Eigen::Vector3d> nodes{{0, 0, 0}};
  std::vector<std::pair<int, int>> struts;
  for (int i = 0; i < 10; ++i) {
    nodes.emplace_back(8 * i - 36, 0, 40);
    struts.emplace_back(i + 1, 0);
  }
  FrameProblem problem = testing::bare_problem(nodes, struts);
  problem.element = ElementModel::kAxial;
  for (std::size_t i = 0; i < nodes.size(); ++i) problem.fixed[i] = {i > 0, true, i > 0};
  problem.displacement_limit_mm = 0.05;
  problem.load_cases = {testing::load_at(problem, 0, {0, 0, -200})};
  return problem;
}

Design sized(const FrameProblem& problem, Session& session) {
  Design design = initial_design(problem);
  take_sizing(design, size_frame(problem, {}, session));
  design.warm = session.latest();
  return design;
}

TEST(RestoreStruts, ComeBackInDescendingAreaUntilTheFrameHolds) {
  OptimizeOptions options;
  RunContext context;
  Session session(options, context);
  const Design design = sized(crowded_truss(), session);
  // All are called thin; the two in the middle least so.
  std::vector<double> areas(10, 1e-6);
  areas[4] = areas[5] = 2e-6;
  areas[0] = 1.5e-6;
  const auto fewer = without_thin_struts(design, areas, 0.5, session);
  ASSERT_TRUE(fewer.has_value());
  EXPECT_EQ(fewer->strut_origin, std::vector<int>({0, 4, 5})) << "30 % of ten, the largest first";
  EXPECT_LE(fewer->volume_mm3, design.volume_mm3);
  EXPECT_EQ(violated_constraint(evaluate(fewer->problem, radii_of(fewer->areas_mm2)), 1e-5), "");
}

TEST(RestoreStruts, NothingGoesWhereNothingIsThin) {
  OptimizeOptions options;
  RunContext context;
  Session session(options, context);
  const Design design = sized(crowded_truss(), session);
  EXPECT_FALSE(without_thin_struts(design, std::vector<double>(10, 5.0), 0.5, session).has_value());
}

TEST(WarmStart, KnownDualsSaveMostIterationsAndLeadToTheSameOptimum) {
  FrameProblem problem = testing::make_egg(testing::Egg{2, 10, 7, 150, 1.0});
  problem.load_cases = {testing::top_load(problem, "side", {0, 15, 0})};
  OptimizeOptions options;
  RunContext context;
  Session cold(options, context);
  Design design = sized(problem, cold);
  const double volume = design.volume_mm3;
  const int before = cold.effort().iterations;
  const std::vector<double> hint = design.areas_mm2;
  ASSERT_TRUE(size_again(design, hint, std::nullopt, cold));
  EXPECT_LE(cold.effort().iterations - before, before / 2);
  EXPECT_NEAR(design.volume_mm3, volume, 1e-6 * volume);
}

TEST(SizeAgain, GivesUpOnAFrameThatIsSureToBeLarger) {
  FrameProblem problem = testing::make_egg(testing::Egg{2, 10, 7, 150, 1.0});
  problem.load_cases = {testing::top_load(problem, "side", {0, 15, 0})};
  OptimizeOptions options;
  RunContext context;
  Session session(options, context);
  Design design = sized(problem, session);
  const Design as_it_was = design;
  const std::vector<double> hint = design.areas_mm2;
  EXPECT_FALSE(size_again(design, hint, 0.9 * design.volume_mm3, session));
  EXPECT_EQ(design.areas_mm2, as_it_was.areas_mm2);
  EXPECT_EQ(design.volume_mm3, as_it_was.volume_mm3);
}

}  // namespace
}  // namespace skinframe
