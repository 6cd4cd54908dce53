// SPDX-License-Identifier: GPL-3.0-or-later
// Algorithm 1 broken off after any of its stages goes on to the same result, bit for bit.
#include <gtest/gtest.h>

#include <map>

#include "tests/worker/fixture/checkpoint_box.h"
#include "tests/worker/optimize/test_frames.h"
#include "worker/optimize/optimize_frame.h"

namespace skinframe {
namespace {

FrameProblem loaded_egg() {
  FrameProblem problem = testing::make_egg(testing::Egg{});
  problem.load_cases = {testing::top_load(problem, "side", {0, 20, 0})};
  return problem;
}

OptimizeResult optimised(const FrameProblem& problem, OptimizeOptions options, Checkpoints* checkpoints) {
  RunContext context;
  options.checkpoints = checkpoints;
  auto result = optimize_frame(problem, options, context);
  EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().message);
  return std::move(result).value();
}

void expect_same_record(const StageRecord& a, const StageRecord& b) {
  EXPECT_EQ(a.nodes, b.nodes);
  EXPECT_EQ(a.struts, b.struts);
  EXPECT_EQ(a.volume_mm3, b.volume_mm3);
}

void expect_same(const OptimizeResult& a, const OptimizeResult& b) {
  EXPECT_EQ(a.reason, b.reason);
  EXPECT_EQ(a.detail, b.detail);
  EXPECT_EQ(a.radii_mm, b.radii_mm);
  EXPECT_EQ(a.problem.frame.nodes_mm, b.problem.frame.nodes_mm);
  EXPECT_EQ(a.displacements_mm, b.displacements_mm);
  EXPECT_EQ(a.node_origin, b.node_origin);
  EXPECT_EQ(a.strut_origin, b.strut_origin);
  expect_same_record(a.initial, b.initial);
  expect_same_record(a.size, b.size);
  expect_same_record(a.topology, b.topology);
  expect_same_record(a.geometry, b.geometry);
  EXPECT_EQ(a.outer_iterations, b.outer_iterations);
  EXPECT_EQ(a.interior_point_iterations, b.interior_point_iterations);
  EXPECT_EQ(a.factorisations, b.factorisations);
  EXPECT_EQ(a.kkt_residual, b.kkt_residual);
  EXPECT_EQ(a.lower_bound_mm3, b.lower_bound_mm3);
  EXPECT_EQ(a.gap, b.gap);
  EXPECT_EQ(a.relaxed_lower_bound_mm3, b.relaxed_lower_bound_mm3);
  EXPECT_EQ(a.relaxed_gap, b.relaxed_gap);
  ASSERT_EQ(a.lower_bound_proof.has_value(), b.lower_bound_proof.has_value());
  if (a.lower_bound_proof) {
    EXPECT_EQ(a.lower_bound_proof->balance_multipliers, b.lower_bound_proof->balance_multipliers);
  }
}

TEST(Checkpoint, FromEachStageTheResultIsThatOfTheUnbrokenRun) {
  const FrameProblem problem = loaded_egg();
  for (const auto order : {OptimizeOptions::Order::kTight, OptimizeOptions::Order::kPaper}) {
    OptimizeOptions options;
    options.order = order;
    const OptimizeResult unbroken = optimised(problem, options, nullptr);
    testing::CheckpointBox all;
    expect_same(optimised(problem, options, &all), unbroken);
    ASSERT_GE(all.history().size(), 3u);  // size, topology, geometry
    for (std::size_t i = 0; i < all.history().size(); ++i) {
      testing::CheckpointBox earlier({all.history()[i]});
      expect_same(optimised(problem, options, &earlier), unbroken);
      EXPECT_EQ(earlier.stages_used(), std::vector<std::string>{all.history()[i].stage}) << i;
      EXPECT_EQ(earlier.history().size(), all.history().size() - 1 - i)
          << "what was finished is not done again";
    }
  }
}

TEST(Checkpoint, OfAnotherProblemOrOtherOptionsIsNotFound) {
  FrameProblem problem = loaded_egg();
  testing::CheckpointBox all;
  optimised(problem, {}, &all);
  testing::CheckpointBox earlier({all.history().front()});
  OptimizeOptions options;
  options.topology_xi = 0.04;
  optimised(problem, options, &earlier);
  problem.displacement_limit_mm = *problem.displacement_limit_mm * (1 + 1e-12);
  optimised(problem, {}, &earlier);
  EXPECT_TRUE(earlier.stages_used().empty());
}

TEST(Checkpoint, ThatMakesNoSenseIsRefusedAndTheRunBeginsAnew) {
  const FrameProblem problem = loaded_egg();
  testing::CheckpointBox all;
  const OptimizeResult unbroken = optimised(problem, {}, &all);
  const auto& good = all.history().front();
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{1}, good.bytes.size() / 2, good.bytes.size() - 1}) {
    auto damaged = good;
    damaged.bytes.resize(size);
    testing::CheckpointBox earlier({damaged});
    expect_same(optimised(problem, {}, &earlier), unbroken);
    EXPECT_EQ(earlier.refusals(), 1) << size;
  }
  auto longer = good;
  longer.bytes += "x";
  testing::CheckpointBox earlier({longer});
  expect_same(optimised(problem, {}, &earlier), unbroken);
  EXPECT_EQ(earlier.refusals(), 1);
}

}  // namespace
}  // namespace skinframe
