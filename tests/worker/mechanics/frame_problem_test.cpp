// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/mechanics/frame_problem.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/worker/mechanics/small_frames.h"

namespace skinframe {
namespace {

using testing::chain;
using ::testing::HasSubstr;
using testing::load_at;

void expect_refused(const FrameProblem& problem, const std::string& naming) {
  const Status status = validate(problem);
  ASSERT_FALSE(status.ok()) << naming;
  EXPECT_EQ(status.error().kind, ErrorKind::kInvalidInput);
  EXPECT_THAT(status.error().message, HasSubstr(naming));
}

TEST(FrameProblem, WellFormedProblemIsValid) {
  FrameProblem problem = chain(3, 60);
  problem.load_cases = {load_at(problem, 3, {0, 0, 1})};
  EXPECT_TRUE(validate(problem).ok());
}

TEST(FrameProblem, RefusalNamesTheElement) {
  FrameProblem problem = chain(3, 60);
  problem.frame.struts[1].b = 9;
  expect_refused(problem, "struts[1].b: 9 is not a node (0..3)");
  problem = chain(3, 60);
  problem.frame.nodes_mm[2] = problem.frame.nodes_mm[1];
  expect_refused(problem, "struts[1]");
  problem = chain(3, 60);
  problem.frame.struts[2] = {1, 0, false};
  expect_refused(problem, "joined twice");
  problem = chain(3, 60);
  problem.bounds[0] = {2, 1};
  expect_refused(problem, "struts[0]");
  problem = chain(3, 60);
  problem.frame.nodes_mm[1].y() = std::numeric_limits<double>::quiet_NaN();
  expect_refused(problem, "nodes[1]");
  problem = chain(3, 60);
  problem.material.slenderness = -1;
  expect_refused(problem, "slenderness");
  problem = chain(3, 60);
  problem.displacement_limit_mm = 0;
  expect_refused(problem, "displacement_limit_mm");
}

TEST(FrameProblem, NodeThatIsHeldOrLoadedCannotBeFree) {
  FrameProblem problem = chain(3, 60);
  problem.free_nodes = {true, false, false, false};
  expect_refused(problem, "node 0 is fixed");
  problem.free_nodes = {false, false, false, true};
  problem.load_cases = {load_at(problem, 3, {0, 0, 1})};
  expect_refused(problem, "node 3 is loaded");
}

}  // namespace
}  // namespace skinframe
