// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/stress/quadratic_solid.h"

#include <gtest/gtest.h>

#include "tests/worker/stress/tet_block.h"

namespace skinframe {
namespace {

using Eigen::Vector3d;

bool at_the_foot(const Vector3d& p) { return p.z() < 1e-9; }

// A tower of 10 x 10 x 100 mm pushed at its top: Timoshenko's beam. Constant strain would be a seventh too
// stiff.
TEST(QuadraticSolid, ATowerBendsAsTimoshenkosBeam) {
  const TetMesh mesh = test::tet_block({2, 2, 20}, {10, 10, 100});
  RunContext context;
  const auto answers = solve_quadratic_solid(
      mesh, {1000, 0.3}, 0, at_the_foot, {{"side", false, {{"side", {5, 5, 100}, {3, 0, 0}, 5}}}}, context);
  ASSERT_TRUE(answers.ok()) << answers.error().message;
  const double beam = 3 * 1e6 / (3 * 1000 * 1e4 / 12) + 3 * 100 / (5.0 / 6 * 1000 / 2.6 * 100);
  EXPECT_NEAR(answers->front().external_work_n_mm / 3 / beam, 1, 0.015);
  EXPECT_NEAR(answers->front().max_displacement_mm / beam, 1, 0.02);
}

TEST(QuadraticSolid, AColumnSinksUnderItsWeight) {
  const TetMesh mesh = test::tet_block({2, 2, 10}, {10, 10, 50});
  RunContext context;
  const auto answers =
      solve_quadratic_solid(mesh, {1000, 0.0}, 1e-3, at_the_foot, {{"self-weight", true, {}}}, context);
  ASSERT_TRUE(answers.ok()) << answers.error().message;
  EXPECT_NEAR(answers->front().max_displacement_mm, 1e-3 * 50 * 50 / (2 * 1000), 1e-9);
  EXPECT_EQ(answers->front().external_work_n_mm, 0);
}

TEST(QuadraticSolid, WhatNothingHoldsIsRefused) {
  RunContext context;
  EXPECT_FALSE(solve_quadratic_solid(
                   test::tet_block({1, 1, 1}, {1, 1, 1}), {1000, 0.3}, 0,
                   [](const Vector3d&) { return false; }, {{"none", false, {}}}, context)
                   .ok());
}

}  // namespace
}  // namespace skinframe
