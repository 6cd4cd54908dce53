// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/design.h"

#include <gtest/gtest.h>

#include "tests/worker/mechanics/small_frames.h"

namespace skinframe {
namespace {

using testing::bare_problem;

// Skin triangle 0-1-2, fixed at 0; internal nodes 3..6.
Design sample() {
  FrameProblem problem = bare_problem(
      {{0, 0, 0}, {60, 0, 0}, {0, 60, 0}, {20, 20, 20}, {20, 20, 40}, {30, 10, 50}, {10, 30, 50}},
      {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}, {3, 4}, {5, 6}, {4, 5}});
  for (int j = 0; j < 3; ++j) problem.frame.struts[j].is_skin = true;
  problem.frame.skin_node_count = 3;
  problem.frame.skin_triangles = {{0, 1, 2}};
  problem.fixed[0] = {true, true, true};
  problem.free_nodes = {false, false, false, true, true, true, true};
  Design design = initial_design(problem);
  design.areas_mm2 = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  return design;
}

TEST(ReducedDesign, DanglingChainsAndWhatTheyLeadToGo) {
  const Design reduced = reduced_design(sample(), std::vector<bool>(9, true));
  EXPECT_EQ(reduced.node_origin, (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(reduced.strut_origin, (std::vector<int>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(reduced.areas_mm2, (std::vector<double>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(reduced.problem.frame.skin_node_count, 3);
  EXPECT_EQ(reduced.problem.frame.skin_triangles.size(), 1u);
  EXPECT_TRUE(validate(reduced.problem).ok());
}

TEST(ReducedDesign, ComponentsThatFloatGo) {
  std::vector<bool> keep(9, true);
  keep[3] = keep[4] = keep[5] = false;  // 3-4-5-6 floats
  EXPECT_EQ(reduced_design(sample(), keep).node_origin, (std::vector<int>{0, 1, 2}));
}

TEST(ReducedDesign, LoadedNodeStaysWithItsChain) {
  Design design = sample();
  design.problem.free_nodes[6] = false;
  design.problem.load_cases = {testing::load_at(design.problem, 6, {0, 0, -1})};
  const Design reduced = reduced_design(design, std::vector<bool>(9, true));
  EXPECT_EQ(reduced.node_origin.size(), 7u);
  EXPECT_EQ(reduced.problem.load_cases[0].force_n[6].z(), -1);
}

TEST(ReducedDesign, OriginsLeadBackThroughSeveralReductions) {
  Design once = reduced_design(sample(), {true, true, true, true, true, true, false, false, false});
  const Design twice = reduced_design(once, {false, true, true, true, true, true});
  EXPECT_EQ(twice.strut_origin, (std::vector<int>{1, 2, 3, 4, 5}));
}

}  // namespace
}  // namespace skinframe
