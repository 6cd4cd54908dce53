// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/mechanics/equilibrium.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "tests/worker/mechanics/small_frames.h"

namespace skinframe {
namespace {

using Eigen::Vector3d;
using testing::bare_problem;
using testing::chain;
using testing::load_at;
using testing::two_strut_truss;

// Symmetric truss: 2 (gamma A / l) sin^2 u = F with sin = h / l.
TEST(Equilibrium, TwoStrutTrussFollowsAlgebra) {
  const double w = 30, h = 40, l = 50, area = 7, force = 100;
  FrameProblem problem = two_strut_truss(w, h);
  problem.load_cases = {load_at(problem, 2, {0, 0, -force})};
  const CaseResponse r = solve_equilibrium(problem, {area, area})[0];
  const double sine = h / l;
  const double drop = force / (2 * 1586 * area / l * sine * sine);
  EXPECT_NEAR(r.displacements_mm[2].z(), -drop, 1e-12 * drop);
  EXPECT_NEAR(r.displacements_mm[2].x(), 0, 1e-12);
  EXPECT_NEAR(r.axial_stress_mpa[0] * area, force / (2 * sine), 1e-9);  // tension
  EXPECT_NEAR(r.reactions_n[0].z(), force / 2, 1e-9);
  EXPECT_NEAR(r.reactions_n[0].x(), -force / 2 * w / h, 1e-9);
  EXPECT_TRUE(r.in_equilibrium);
}

// Pulled along, a chain is a bar: F L / (gamma A). Pushed across, the paper's element is a shear spring: F L
// / (mu A).
TEST(Equilibrium, ChainIsABarAlongAndAShearSpringAcross) {
  for (int struts : {1, 4, 16}) {
    FrameProblem problem = chain(struts, 100);
    problem.load_cases = {load_at(problem, struts, {3, 0, 0}), load_at(problem, struts, {0, 3, 0})};
    const double area = std::numbers::pi;
    const auto responses = solve_equilibrium(problem, std::vector<double>(struts, area));
    EXPECT_NEAR(responses[0].max_displacement_mm, 3 * 100 / (1586 * area), 1e-12);
    EXPECT_NEAR(responses[1].max_displacement_mm, 3 * 100 / (1387 * area), 1e-12);
    EXPECT_NEAR(responses[0].axial_stress_mpa[0], 3 / area, 1e-10);
    EXPECT_NEAR(responses[1].shear_stress_mpa[0], 3 / area, 1e-10);
  }
}

// A hanging chain of n struts: strut i carries the weight below its middle, counted from the lumped halves.
TEST(Equilibrium, HangingChainCarriesItsOwnWeight) {
  FrameProblem problem = bare_problem({{0, 0, 0}, {0, 0, -50}, {0, 0, -100}}, {{0, 1}, {1, 2}});
  problem.fixed[0] = {true, true, true};
  problem.load_cases = {load_at(problem, 2, Vector3d::Zero(), true)};
  const double area = 4, weight = 1.15e-9 * 9810 * 50 * area;  // of one strut
  const CaseResponse r = solve_equilibrium(problem, {area, area})[0];
  EXPECT_NEAR(r.axial_stress_mpa[1] * area, weight / 2, 1e-15);
  EXPECT_NEAR(r.axial_stress_mpa[0] * area, 1.5 * weight, 1e-15);
  EXPECT_NEAR(r.reactions_n[0].z(), 2 * weight, 1e-15);
}

TEST(Equilibrium, ReactionsBalanceTheLoads) {
  FrameProblem problem = bare_problem({{0, 0, 0}, {60, 0, 0}, {0, 60, 0}, {20, 20, 70}},
                                      {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}});
  for (int i = 0; i < 3; ++i) problem.fixed[i] = {true, true, true};
  problem.skin_weight_n = {0.1, 0.2, 0.3, 0.4};
  problem.load_cases = {load_at(problem, 3, {5, -2, -9}, true)};
  const std::vector<double> areas{1, 2, 3, 4, 5, 6};
  const CaseResponse r = solve_equilibrium(problem, areas)[0];
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& load : nodal_loads_n(problem, areas, 0)) sum += load;
  for (const Vector3d& reaction : r.reactions_n) sum += reaction;
  EXPECT_LT(sum.norm(), 1e-10);
  EXPECT_LT(r.residual, 1e-12);
}

TEST(Equilibrium, TurningFrameAndLoadAboutZTurnsDisplacements) {
  FrameProblem problem = bare_problem({{0, 0, 0}, {60, 0, 0}, {0, 60, 0}, {20, 20, 70}, {35, 10, 110}},
                                      {{0, 3}, {1, 3}, {2, 3}, {3, 4}, {1, 4}, {2, 4}});
  for (int i = 0; i < 3; ++i) problem.fixed[i] = {true, true, true};
  problem.load_cases = {load_at(problem, 4, {5, -2, -9}, true)};
  const std::vector<double> areas{1, 2, 3, 4, 5, 6};
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vector3d::UnitZ()).toRotationMatrix();
  FrameProblem turned = problem;
  for (Vector3d& p : turned.frame.nodes_mm) p = turn * p;
  for (Vector3d& f : turned.load_cases[0].force_n) f = turn * f;
  const CaseResponse r = solve_equilibrium(problem, areas)[0], rt = solve_equilibrium(turned, areas)[0];
  for (std::size_t i = 0; i < problem.frame.nodes_mm.size(); ++i)
    EXPECT_LT((rt.displacements_mm[i] - turn * r.displacements_mm[i]).norm(), 1e-12);
}

// The truss can swing out of its plane when y is free: only a load that excites this is out of equilibrium.
TEST(Equilibrium, MechanismIsToldOnlyWhenTheLoadExcitesIt) {
  FrameProblem problem = two_strut_truss(30, 40);
  problem.fixed[2] = {false, false, false};
  problem.load_cases = {load_at(problem, 2, {0, 0, -10}), load_at(problem, 2, {0, 1, -10})};
  const auto responses = solve_equilibrium(problem, {7, 7});
  EXPECT_TRUE(responses[0].in_equilibrium);
  EXPECT_FALSE(responses[1].in_equilibrium);
  EXPECT_GT(responses[1].residual, 0.05);
}

TEST(Equilibrium, SolverMayBeUsedAgainWithOtherAreas) {
  FrameProblem problem = chain(3, 90);
  problem.load_cases = {load_at(problem, 3, {3, 0, 0})};
  EquilibriumSolver solver(problem);
  const double thin = solver.solve({1, 1, 1})[0].max_displacement_mm;
  const double thick = solver.solve({2, 2, 2})[0].max_displacement_mm;
  EXPECT_NEAR(thin, 2 * thick, 1e-12);
}

}  // namespace
}  // namespace skinframe
