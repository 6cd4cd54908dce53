// SPDX-License-Identifier: GPL-3.0-or-later
// Closed forms of the textbooks, and what every answer has to keep.
#include "worker/structure/solve_structure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/worker/structure/grids.h"

namespace skinframe {
namespace {

using Eigen::Vector3d;
using test::chain;
using test::factorised;
using test::no_load;
using test::plate_grid;
using test::ShellGrid;

const ElasticMaterial kPa{1586, 0.35};
constexpr double pi = std::numbers::pi;

TEST(SolveStructure, ObliqueCantileverOfManyStruts) {
  Structure s = chain({0, 0, 0}, {30, 32, 24}, 10, 2, kPa);
  s.held[0] = kClamped;
  const Vector3d across = Vector3d(0.6, 0.64, 0.48).cross(Vector3d::UnitZ()).normalized();
  NodalColumns f = no_load(s);
  f.block<3, 1>(60, 0) = across;
  const NodalColumns d = factorised(s).solve(f);
  const double exact = 125000 / (3 * 1586 * 4 * pi) + 50 / (8.1 / 9.1 * 1586 / 2.7 * 4 * pi);
  const double tip = d.block<3, 1>(60, 0).dot(across);
  EXPECT_NEAR(tip, exact, 1e-8 * exact);
}

// Columns h and a beam b, feet clamped, all of the same slender bar, a push H at the top:
// sway = H h^3 (3 k + 2) / (12 E I (6 k + 1)), k = (I_beam / b) / (I_column / h) = h / b (slope deflection,
// with half of H at either corner).
TEST(SolveStructure, PortalFrameSwaysAsTheFrameFormulasSay) {
  const double h = 300, b = 200, r = 1;
  Structure s = chain({0, 0, 0}, {0, 0, h}, 1, r, kPa);
  s.nodes_mm.push_back({b, 0, h});
  s.nodes_mm.push_back({b, 0, 0});
  s.held = {kClamped, kFree, kFree, kClamped};
  for (const auto& ends : {std::array{1, 2}, std::array{2, 3}}) {
    StructureStrut strut;
    strut.nodes = ends;
    strut.radius_mm = r;
    s.struts.push_back(strut);
  }
  NodalColumns f = no_load(s);
  f(6, 0) = 0.05;
  f(12, 0) = 0.05;
  const double k = h / b, inertia = pi / 4;
  const double exact = 0.1 * h * h * h * (3 * k + 2) / (12 * 1586 * inertia * (6 * k + 1));
  EXPECT_NEAR(factorised(s).solve(f)(6, 0) / exact, 1, 2e-3);  // the bars also stretch and shear a little
}

TEST(SolveStructure, CantileverOfShellsBendsInItsPlaneWithoutLocking) {
  for (const int n : {1, 2, 4}) {
    ShellGrid g = plate_grid(32, 2, 16 * n, n, 1, {1000, 0.25});
    NodalColumns f = no_load(g.structure);
    for (int j = 0; j <= n; ++j) {
      g.structure.held[g.node(0, j)] = kClamped;
      f(6 * g.node(16 * n, j) + 1, 0) = (j == 0 || j == n ? 0.5 : 1.0) / n;
    }
    const double exact = 32.0 * 32 * 32 / (3 * 1000 * 8.0 / 12) + 32 / (5.0 / 6 * 400 * 2);
    const double tip = factorised(g.structure).solve(f)(6 * g.node(16 * n, 0) + 1, 0);
    EXPECT_NEAR(tip / exact, 1, n == 1 ? 0.03 : 0.01) << n;
  }
}

// Timoshenko and Woinowsky-Krieger, tables 23, 8 and 35: w = coefficient * load * side^2 or ^4 / D.
TEST(SolveStructure, ClampedAndSupportedPlates) {
  const double side = 100, bending = 1000 / (12 * 0.91);
  for (const bool clamped : {true, false}) {
    ShellGrid g = plate_grid(side, side, 32, 32, 1, {1000, 0.3});
    NodalColumns f = NodalColumns::Zero(6 * g.structure.nodes_mm.size(), 2);
    for (int i = 0; i <= 32; ++i)
      for (int j = 0; j <= 32; ++j) {
        const int v = g.node(i, j);
        if (i == 0 || j == 0 || i == 32 || j == 32) {
          if (clamped) g.structure.held[v] = kClamped;
          g.structure.held[v][0] = g.structure.held[v][1] = g.structure.held[v][2] = true;
        } else {
          f(6 * v + 2, 1) = side * side / (32 * 32);  // 1 MPa
        }
      }
    const int middle = 6 * g.node(16, 16) + 2;
    f(middle, 0) = 1;
    const NodalColumns d = factorised(g.structure).solve(f);
    EXPECT_NEAR(d(middle, 0) / ((clamped ? 0.00560 : 0.01160) * side * side / bending), 1, 0.012) << clamped;
    EXPECT_NEAR(d(middle, 1) / ((clamped ? 0.00126 : 0.00406) * std::pow(side, 4) / bending), 1, 0.012)
        << clamped;
  }
}

// Belytschko et al. 1985: cylinder with end diaphragms, an eighth of it; 1.8248e-5 under the load.
TEST(SolveStructure, PinchedCylinderReaches97PercentOfItsDeflectionOnSixteenBySixteen) {
  const int n = 16;
  ShellGrid g = test::shell_grid(n, n, 3, {3e6, 0.3}, false, [](double u, double v) {
    return Vector3d(300 * u, 300 * std::sin(v * pi / 2), 300 * std::cos(v * pi / 2));
  });
  auto& held = g.structure.held;
  const auto hold = [&](int v, std::initializer_list<int> freedoms) {
    for (const int k : freedoms) held[v][k] = true;
  };
  for (int j = 0; j <= n; ++j) {
    hold(g.node(0, j), {0, 4, 5});  // middle: symmetry in x
    hold(g.node(n, j), {1, 2, 3});  // diaphragm
  }
  for (int i = 0; i <= n; ++i) {
    hold(g.node(i, 0), {1, 3, 5});
    hold(g.node(i, n), {2, 3, 4});
  }
  NodalColumns f = no_load(g.structure);
  f(2, 0) = -0.25;
  const double ratio = -factorised(g.structure).solve(f)(2, 0) / 1.8248e-5;
  EXPECT_GE(ratio, 0.97);
  EXPECT_LE(ratio, 1.03);
}

// A bent plate with a rib below it and a pillar on it, loaded askew: what all further tests turn and weigh.
struct Mixed {
  Structure structure;
  NodalColumns loads;
};
Mixed mixed() {
  ShellGrid g = test::shell_grid(6, 4, 1.2, kPa, true, [](double u, double v) {
    return Vector3d(40 * u, 25 * v, 6 * std::sin(2 * u + v));
  });
  Structure& s = g.structure;
  s.weight_density_n_mm3 = 1.1e-5;
  for (int i = 0; i < 6; ++i) {
    StructureStrut rib;
    rib.nodes = {g.node(i, 2), g.node(i + 1, 2)};
    rib.shape = StrutShape::kHalfDisc;
    rib.arm = {Vector3d(0.2, 0.1, -1).normalized(), Vector3d(0.15, 0.1, -1).normalized()};
    rib.arm_mm = 0.6;
    rib.radius_mm = 0.9;
    s.struts.push_back(rib);
  }
  s.nodes_mm.push_back({35, 12, 30});
  StructureStrut pillar;
  pillar.nodes = {g.node(5, 2), static_cast<int>(s.nodes_mm.size()) - 1};
  pillar.radius_mm = 1.5;
  s.struts.push_back(pillar);
  s.held.push_back(kFree);
  for (int j = 0; j <= 4; ++j) s.held[g.node(0, j)] = kClamped;
  Mixed out{s, NodalColumns::Zero(6 * static_cast<Eigen::Index>(s.nodes_mm.size()), 2)};
  out.loads.col(0) = self_weight_n(s);
  out.loads.col(1).tail<6>() << 3, 5, -7, 11, -2, 4;
  return out;
}

TEST(SolveStructure, ReactionsBalanceForcesAndMomentsToEightDigits) {
  const Mixed m = mixed();
  const StructureSolver solver = factorised(m.structure);
  const NodalColumns d = solver.solve(m.loads);
  EXPECT_LT(solver.residual(d, m.loads), 1e-8);
  const Balance balance = solver.balance(d, m.loads);
  EXPECT_LT(balance.force, kBalanceTolerance);
  EXPECT_LT(balance.moment, kBalanceTolerance);
}

TEST(SolveStructure, BalanceNoticesAnAnswerThatIsNone) {
  const Mixed m = mixed();
  const StructureSolver solver = factorised(m.structure);
  NodalColumns d = solver.solve(m.loads);
  d.col(1) *= 1.001;
  const Balance balance = solver.balance(d, m.loads);
  EXPECT_GT(std::max(balance.force, balance.moment), kBalanceTolerance);
  EXPECT_GT(solver.residual(d, m.loads), 1e-6);
}

TEST(SolveStructure, TurningMeshLoadsAndSupportsTurnsTheAnswer) {
  const Mixed m = mixed();
  const NodalColumns d = factorised(m.structure).solve(m.loads);
  for (const Vector3d& axis : {Vector3d(1, 0, 0), Vector3d(0, 1, 0), Vector3d(3, -2, 5)}) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, axis.normalized()).toRotationMatrix();
    Mixed t = m;
    for (Vector3d& p : t.structure.nodes_mm) p = Vector3d(turn * p);
    for (StructureStrut& strut : t.structure.struts)
      for (Vector3d& arm : strut.arm) arm = Vector3d(turn * arm);
    for (Eigen::Index i = 0; i < m.loads.rows(); i += 3)
      t.loads.middleRows<3>(i) = Eigen::MatrixXd(turn * m.loads.middleRows<3>(i));
    const NodalColumns turned = factorised(t.structure).solve(t.loads);
    for (Eigen::Index c = 0; c < 2; ++c) {
      double worst = 0;
      for (Eigen::Index i = 0; i < d.rows(); i += 3)
        worst = std::max(worst, (turned.block<3, 1>(i, c) - turn * d.block<3, 1>(i, c)).norm());
      EXPECT_LT(worst, 1e-9 * d.col(c).cwiseAbs().maxCoeff());
    }
  }
}

TEST(SolveStructure, WeightIsThatOfTheNominalVolume) {
  const Mixed m = mixed();
  double weight = 0;
  for (std::size_t i = 0; i < m.structure.nodes_mm.size(); ++i) weight -= m.loads(6 * i + 2, 0);
  EXPECT_NEAR(weight, 1.1e-5 * structure_volume_mm3(m.structure), 1e-12 * weight);
}

TEST(SolveStructure, WhatIsNotHeldIsRefused) {
  Mixed m = mixed();
  for (auto& held : m.structure.held) held = kFree;
  RunContext context;
  const auto solver = StructureSolver::factorise(m.structure, context);
  ASSERT_FALSE(solver.ok());
  EXPECT_THAT(solver.error().message, testing::HasSubstr("not held"));
}

TEST(SolveStructure, AnElementThatIsNoneIsNamed) {
  RunContext context;
  Mixed m = mixed();
  m.structure.shells[7].nodes = {3, 3, 4};
  EXPECT_THAT(StructureSolver::factorise(m.structure, context).error().message,
              testing::HasSubstr("shells[7]"));
  m = mixed();
  m.structure.struts[2].radius_mm = 0;
  EXPECT_THAT(StructureSolver::factorise(m.structure, context).error().message,
              testing::HasSubstr("struts[2]"));
}

}  // namespace
}  // namespace skinframe
