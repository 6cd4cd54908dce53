// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/structure/buckling.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

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

// The same eigenproblem, assembled dense and solved whole.
double factor_of_dense(const StructureSolver& solver, const Eigen::VectorXd& displacement) {
  const Structure& s = solver.structure();
  const int n = solver.free_count();
  Eigen::MatrixXd stiffness(n, n), compression = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i) stiffness.col(i) = solver.multiply_free(Eigen::VectorXd::Unit(n, i));
  const auto add = [&](const auto& nodes, const auto& k) {
    for (int i = 0; i < k.rows(); ++i)
      for (int j = 0; j < k.cols(); ++j) {
        const int row = solver.free_index(nodes[i / 6], i % 6),
                  column = solver.free_index(nodes[j / 6], j % 6);
        if (row >= 0 && column >= 0) compression(row, column) -= k(i, j);
      }
  };
  for (std::size_t i = 0; i < s.shells.size(); ++i) {
    const auto stress = shell_stress(s.shell(i), s.material, freedoms_of(s.shells[i], displacement));
    add(s.shells[i].nodes, shell_geometric_stiffness(s.shell(i), stress.membrane_mpa));
  }
  for (std::size_t j = 0; j < s.struts.size(); ++j) {
    const auto stress = rigid_strut_stress(s.strut(j), s.material, freedoms_of(s.struts[j], displacement));
    add(s.struts[j].nodes, rigid_strut_geometric_stiffness(s.strut(j), stress.axial_force_n));
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> eigen(compression, stiffness,
                                                                        Eigen::EigenvaluesOnly);
  SKINFRAME_CHECK(eigen.info() == Eigen::Success);
  return 1 / eigen.eigenvalues()[n - 1];
}

TEST(Buckling, IsTheLeastOfAllFactorsOfSkinAndStrut) {
  auto g = test::plate_grid(40, 20, 6, 4, 1, {1586, 0.35});
  Structure& s = g.structure;
  StructureStrut strut;
  strut.nodes = {g.node(6, 0), g.node(0, 4)};
  strut.radius_mm = 1;
  s.struts.push_back(strut);
  for (int j = 0; j <= 4; ++j) s.held[g.node(0, j)] = kClamped;
  NodalColumns f = NodalColumns::Zero(6 * s.nodes_mm.size(), 4);
  f(6 * g.node(6, 2), 0) = -3;
  f(6 * g.node(6, 2) + 1, 1) = 5;
  f(6 * g.node(6, 4) + 1, 2) = -2;  // nothing acts in the last one
  const StructureSolver solver = factorised(s);
  const NodalColumns d = solver.solve(f);
  for (int c = 0; c < 3; ++c) {
    const auto factor = buckling_factor(solver, d.col(c));
    ASSERT_TRUE(factor.ok()) << factor.error().message;
    ASSERT_TRUE(factor->has_value());
    EXPECT_NEAR(**factor / factor_of_dense(solver, d.col(c)), 1, kBucklingTolerance);
  }
  const auto unloaded = buckling_factor(solver, d.col(3));
  ASSERT_TRUE(unloaded.ok()) << unloaded.error().message;
  EXPECT_FALSE(unloaded->has_value());
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
