// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/interior_point.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "tests/worker/optimize/test_frames.h"
#include "worker/optimize/optimize_frame.h"
#include "worker/optimize/scaled_program.h"

namespace skinframe {
namespace {

using testing::base_hull;
using testing::Egg;
using testing::make_egg;
using testing::top_load;

FrameProblem loaded_egg() {
  FrameProblem problem = make_egg(Egg{});
  problem.load_cases = {top_load(problem, "side", {0, 20, 0})};
  return problem;
}

OptimizeResult optimised(const FrameProblem& problem, const OptimizeOptions& options, int threads = 1) {
  RunContext context;
  context.threads = threads;
  auto result = optimize_frame(problem, options, context);
  EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().message);
  return std::move(result).value();
}

OptimizeOptions size_only() {
  OptimizeOptions options;
  options.relaxed = options.topology = options.geometry = false;
  return options;
}

TEST(ConvergenceTest, StopsAtTheToleranceAndOtherwiseOnlyWhenRoundingEndsTheDescent) {
  const double tolerance = 1e-7;
  EXPECT_EQ(converged({1e-7, 1e-7, 0}, tolerance), InteriorPointEnd::kOptimal);
  EXPECT_EQ(converged({1e-6, 1e-6, kPatience - 1}, tolerance), std::nullopt);
  EXPECT_EQ(converged({1e-3, 1e-6, kPatience}, tolerance), InteriorPointEnd::kAcceptable);
  EXPECT_EQ(converged({1e-4, 1e-4, 10 * kPatience}, tolerance), std::nullopt);
}

TEST(InteriorPoint, CancellationIsHeardWithinAFactorisation) {
  const FrameProblem problem = loaded_egg();
  ProgramRequest request;
  request.cases = {0};
  set_size_bounds(problem, request);
  const std::vector<double> start(problem.frame.struts.size(), 10.0);
  const ScaledProgram scaled(problem, request, start);
  InteriorPointOptions options;
  int asked = 0, asked_before_step = 0, steps = 0;
  options.each = [&](const IterationRecord& record) {
    steps = record.iteration;
    if (steps == 2) asked_before_step = asked;
    return true;
  };
  options.cancelled = [&] { return steps == 2 && ++asked > asked_before_step + 5; };
  const InteriorPointResult result = solve_program(scaled.program(), scaled.start(), options);
  EXPECT_EQ(result.end, InteriorPointEnd::kCancelled);
  EXPECT_EQ(result.iterations, 2) << "the step under way was not finished";
}

TEST(InteriorPoint, LogHasAHeadingAndALineForEachIterate) {
  OptimizeOptions options = size_only();
  std::vector<std::string> lines;
  options.log = [&](const std::string& line) { lines.push_back(line); };
  const OptimizeResult r = optimised(loaded_egg(), options);
  ASSERT_GT(r.interior_point_iterations, 3);
  ASSERT_EQ(lines.size(), r.interior_point_iterations + 2u);
  EXPECT_EQ(lines.front(), iteration_log_header());
  for (const std::string& line : lines) EXPECT_EQ(line.size(), lines.front().size()) << line;
}

TEST(InteriorPoint, SameBitsAtOneAndTwoThreads) {
  const FrameProblem problem = loaded_egg();
  const OptimizeResult one = optimised(problem, {}, 1), two = optimised(problem, {}, 2);
  EXPECT_EQ(one.radii_mm, two.radii_mm);
  EXPECT_EQ(one.problem.frame.nodes_mm, two.problem.frame.nodes_mm);
  EXPECT_EQ(one.interior_point_iterations, two.interior_point_iterations);
}

// Supports that are the same in every direction, and a hull that turns with the frame.
TEST(InteriorPoint, RotatingTheProblemAboutTheVerticalRotatesTheAnswer) {
  FrameProblem problem = loaded_egg();
  problem.balance = base_hull(problem.frame, 0);
  for (std::size_t i = 0; i < problem.fixed.size(); ++i)
    if (problem.fixed[i][2]) problem.fixed[i] = {true, true, true};
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  FrameProblem turned = problem;
  for (Eigen::Vector3d& node : turned.frame.nodes_mm) node = turn * node;
  for (LoadCase& load : turned.load_cases)
    for (Eigen::Vector3d& force : load.force_n) force = turn * force;
  for (HalfPlane& edge : turned.balance) edge.normal = turn.topLeftCorner<2, 2>() * edge.normal;
  turned.skin_mass.centroid_mm = turn * turned.skin_mass.centroid_mm;

  OptimizeOptions options = size_only();
  options.kkt_tolerance = 1e-9;
  const OptimizeResult a = optimised(problem, options), b = optimised(turned, options);
  ASSERT_EQ(a.reason, Termination::kOptimal);
  EXPECT_NEAR(a.size.volume_mm3, b.size.volume_mm3, 1e-6 * a.size.volume_mm3);
  for (std::size_t j = 0; j < a.radii_mm.size(); ++j) EXPECT_NEAR(a.radii_mm[j], b.radii_mm[j], 1e-6) << j;
  for (std::size_t i = 0; i < a.displacements_mm[0].size(); ++i)
    EXPECT_LT((turn * a.displacements_mm[0][i] - b.displacements_mm[0][i]).norm(), 1e-6 * 0.05) << i;
}

}  // namespace
}  // namespace skinframe
