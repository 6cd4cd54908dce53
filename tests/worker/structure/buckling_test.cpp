// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/structure/buckling.h"

#include <gtest/gtest.h>

#include "tests/worker/structure/grids.h"

namespace skinframe {
namespace {

using Eigen::Vector3d;
using test::factorised;
using test::no_load;
constexpr double pi = std::numbers::pi;

double first_factor(const Structure& s, const NodalColumns& f) {
  const StructureSolver solver = factorised(s);
  const auto factor = buckling_factor(solver, solver.solve(f).col(0));
  SKINFRAME_CHECK(factor.ok() && factor->has_value());
  return **factor;
}

TEST(Buckling, ObliqueCantileverColumnIsEulers) {
  Structure s = test::chain({0, 0, 0}, {30, 32, 24}, 10, 1, {1586, 0.35});
  s.held[0] = kClamped;
  NodalColumns f = no_load(s);
  f.block<3, 1>(60, 0) = Vector3d(-0.6, -0.64, -0.48);
  const double euler = euler_load_n(1586, pi / 4, 100);  // twice as long, pinned
  EXPECT_NEAR(first_factor(s, f) / euler, 1, 2e-3);      // shear takes a thousandth
}

TEST(Buckling, TwoPartsFindThePinnedColumnToOnePercent) {
  Structure s = test::chain({0, 0, 0}, {0, 0, 50}, 2, 1, {1586, 0.35});
  s.held[0] = {true, true, true, false, false, true};
  s.held[2] = {true, true, false, false, false, false};
  NodalColumns f = no_load(s);
  f(14, 0) = -1;
  const double factor = first_factor(s, f) / euler_load_n(1586, pi / 4, 50);
  EXPECT_NEAR(factor, 1, 0.012);
}

TEST(Buckling, SupportedSquarePlateUnderEdgeCompression) {
  const int n = 16;
  const double side = 100;
  auto g = test::plate_grid(side, side, n, n, 1, {1000, 0.3});
  NodalColumns f = no_load(g.structure);
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) {
      const int v = g.node(i, j);
      if (i == 0 || j == 0 || i == n || j == n) g.structure.held[v][2] = true;
      if (i == 0) g.structure.held[v][0] = true;
      if (i == n) f(6 * v, 0) = -side / n * (j == 0 || j == n ? 0.5 : 1);
    }
  g.structure.held[g.node(0, 0)][1] = true;
  const double bending = 1000 / (12 * 0.91);
  EXPECT_NEAR(first_factor(g.structure, f) / (4 * pi * pi * bending / (side * side)), 1, 0.02);
}

TEST(Buckling, WhatIsOnlyPulledHasNoFactor) {
  Structure s = test::chain({0, 0, 0}, {0, 0, 50}, 4, 1, {1586, 0.35});
  s.held[0] = kClamped;
  NodalColumns f = no_load(s);
  f(26, 0) = 1;
  const StructureSolver solver = factorised(s);
  const auto factor = buckling_factor(solver, solver.solve(f).col(0));
  ASSERT_TRUE(factor.ok()) << factor.error().message;
  EXPECT_FALSE(factor->has_value());
}

}  // namespace
}  // namespace skinframe
