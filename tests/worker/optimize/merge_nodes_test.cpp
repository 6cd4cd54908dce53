// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/merge_nodes.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/worker/mechanics/small_frames.h"

namespace skinframe {
namespace {

using testing::bare_problem;

// Skin triangle 0 1 2, internal nodes 3 and 4 a hair apart, joined to the skin and to each other.
Design two_close_nodes() {
  FrameProblem problem = bare_problem({{0, 0, 0}, {60, 0, 0}, {0, 60, 0}, {20, 20, 40}, {20, 20, 41}},
                                      {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {1, 4}, {2, 4}, {3, 4}});
  for (int j : {0, 1, 2}) problem.frame.struts[j].is_skin = true;
  problem.frame.skin_node_count = 3;
  problem.frame.skin_triangles = {{0, 1, 2}};
  for (int i : {0, 1, 2}) problem.fixed[i] = {true, true, true};
  problem.load_cases = {testing::load_at(problem, 0, {0, 0, 0}, true)};
  problem.free_nodes = {false, false, false, true, true};
  Design design = initial_design(problem);
  design.areas_mm2 = {1, 1, 1, 2, 3, 4, 5, 6};
  return design;
}

TEST(MergeNodes, ShortestStrutsAreProposedOncePerNode) {
  const Design design = two_close_nodes();
  EXPECT_EQ(contractible_struts(design, 0.3), std::vector<int>({7}));
  EXPECT_TRUE(contractible_struts(design, 0).empty());
}

TEST(MergeNodes, TwoFreeNodesMeetHalfWayAndParallelStrutsAddUp) {
  const auto merged = contracted_design(two_close_nodes(), {7});
  ASSERT_TRUE(merged.has_value());
  const Frame& frame = merged->problem.frame;
  EXPECT_EQ(frame.nodes_mm.size(), 4u);
  EXPECT_EQ(frame.nodes_mm[3], Eigen::Vector3d(20, 20, 40.5));
  ASSERT_EQ(frame.struts.size(), 6u);
  EXPECT_EQ(merged->strut_origin, std::vector<int>({0, 1, 2, 3, 4, 6}));
  EXPECT_EQ(merged->areas_mm2, std::vector<double>({1, 1, 1, 2, 3 + 4, 5}));
  EXPECT_TRUE(validate(merged->problem).ok());
}

TEST(MergeNodes, FreeNodeGoesToTheNodeThatStandsAndTheSkinStrutStays) {
  const auto merged = contracted_design(two_close_nodes(), {3});  // 3 into skin node 0
  ASSERT_TRUE(merged.has_value());
  const Frame& frame = merged->problem.frame;
  EXPECT_EQ(frame.nodes_mm[0], Eigen::Vector3d(0, 0, 0));
  // 1-3 has become 0-1, which is there as a skin strut.
  EXPECT_EQ(merged->strut_origin, std::vector<int>({0, 1, 2, 5, 6, 7}));
  EXPECT_TRUE(frame.struts[0].is_skin);
  EXPECT_EQ(merged->areas_mm2[0], 1 + 3);
  EXPECT_EQ(std::count(merged->node_origin.begin(), merged->node_origin.end(), 3), 0);
  EXPECT_TRUE(validate(merged->problem).ok());
}

TEST(MergeNodes, NodesThatDoNotMoveAreNotMerged) {
  EXPECT_FALSE(contracted_design(two_close_nodes(), {0}).has_value());
}

}  // namespace
}  // namespace skinframe
