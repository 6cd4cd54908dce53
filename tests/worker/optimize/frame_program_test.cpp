// SPDX-License-Identifier: GPL-3.0-or-later
// First derivatives of the program against finite differences, and second derivatives through the property
// that defines a Newton step: along it every equation of the perturbed KKT system falls as 1 - h, up to a
// remainder of order h^2.
#include "worker/optimize/frame_program.h"

#include <gtest/gtest.h>

#include <random>

#include "worker/optimize/interior_point.h"
#include "worker/optimize/newton_step.h"

namespace skinframe {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

// A small program in which every term takes part: two cases, moving nodes, strain limits, half-spaces,
// balance, cap.
FrameProgram sample_program(ElasticScope elastic) {
  FrameProgram p;
  p.struts = {{0, 3}, {1, 3}, {2, 3}, {0, 4}, {1, 4}, {3, 4}, {2, 4}, {3, 5}, {4, 5}};
  p.fixed.assign(6, {false, false, false});
  p.fixed[0] = {true, true, true};
  p.fixed[1] = {false, true, true};
  p.fixed[2] = {true, false, true};
  p.moves = {false, false, false, true, true, false};
  p.springs = {1.0, 0.87, 0.03};
  for (int k = 0; k < 2; ++k) {
    ProgramCase load{NodeMatrix::Zero(3, 6), k == 0 ? 1.0 : 0.0};
    load.force.col(5) = Vector3d(0.2 * k, 0.1, -0.15);
    p.cases.push_back(load);
  }
  p.lower = VectorXd::Constant(9, 0.2);
  p.upper = VectorXd::Constant(9, 4.0);
  p.lower[8] = p.upper[8] = 1.3;  // a given area
  p.area_weights = VectorXd::LinSpaced(9, 0.1, 0.9);
  p.elastic = elastic;
  p.elastic_weight = elastic == ElasticScope::kNone ? 0 : 2.5;
  p.squared_displacement_limit = 1.7;
  p.strain_limits = {{0, StrainKind::kAxial, 0.8},
                     {0, StrainKind::kShear, 0.9},
                     {5, StrainKind::kAxial, 0.7},
                     {7, StrainKind::kShear, 1.1}};
  p.slenderness_area = 0.1;
  p.squared_min_length = VectorXd::Constant(9, 0.2);
  p.half_spaces = {{3, Vector3d(1, 0.2, 0).normalized(), 3}, {4, Vector3d(0, -1, 0.4).normalized(), 4}};
  // More rows than the three sums that carry them.
  p.balance = {{Vector3d(1, 0, 0), 2.0, 0.3, 0.4},
               {Vector3d(-0.6, 0.8, 0), 2.5, -0.2, 0.4},
               {Vector3d(0, -1, 0), 1.5, 0.1, 0.3},
               {Vector3d(0.8, 0.6, 0), 1.9, -0.1, 0.5},
               {Vector3d(-1, 0, 0), 0.7, 0.2, 0.4}};
  p.volume_cap = 14.0;
  return p;
}

ProgramVector sample_point(const FrameProgram& p) {
  std::mt19937 generator(3);
  const auto value = [&] { return static_cast<double>(generator()) / 2147483648.0 - 1; };
  ProgramVector v;
  v.areas = VectorXd::NullaryExpr(9, [&](Eigen::Index) { return 1.3 + 0.4 * value(); });
  v.areas[8] = 1.3;
  v.positions.resize(3, 6);
  v.positions << 0, 1.5, 0, 0.4, 0.9, 0.6,  //
      0, 0, 1.4, 0.5, 0.3, 0.7,             //
      0, 0, 0.1, 1.1, 0.8, 2.0;
  for (int k = 0; k < 2; ++k)
    for (auto* part : {&v.displacements, &v.multipliers}) {
      NodeMatrix m = NodeMatrix::NullaryExpr(3, 6, [&](Eigen::Index, Eigen::Index) { return 0.3 * value(); });
      for (int i = 0; i < 6; ++i)
        for (int axis = 0; axis < 3; ++axis)
          if (p.fixed[i][axis]) m(axis, i) = 0;
      part->push_back(m);
    }
  v.elastic = p.elastic == ElasticScope::kNone ? 0 : 1.4;
  return v;
}

double dot(const ProgramVector& a, const ProgramVector& b) {
  double sum = a.areas.dot(b.areas) + a.positions.cwiseProduct(b.positions).sum() + a.elastic * b.elastic;
  for (std::size_t k = 0; k < a.displacements.size(); ++k)
    sum += a.displacements[k].cwiseProduct(b.displacements[k]).sum() +
           a.multipliers[k].cwiseProduct(b.multipliers[k]).sum();
  return sum;
}

// A direction that keeps what is given: fixed axes, nodes that stand, given areas.
ProgramVector sample_direction(const FrameProgram& p) {
  ProgramVector v = sample_point(p);
  v.areas = VectorXd::LinSpaced(9, -0.5, 0.7);
  v.areas[8] = 0;
  v.positions = NodeMatrix::Zero(3, 6);
  v.positions.col(3) = Vector3d(0.3, -0.2, 0.4);
  v.positions.col(4) = Vector3d(-0.1, 0.5, 0.2);
  v.elastic = p.elastic == ElasticScope::kNone ? 0 : -0.6;
  return v;
}

double lagrangian(const FrameProgram& p, const InequalityLayout& at, const ProgramVector& v,
                  const VectorXd& weights) {
  double value = objective(p, v) + weights.dot(inequalities(p, at, v));
  const auto residuals = equilibrium_residuals(p, v);
  for (std::size_t k = 0; k < residuals.size(); ++k)
    value += residuals[k].cwiseProduct(v.multipliers[k]).sum();
  return value;
}

class FrameProgramOf : public ::testing::TestWithParam<ElasticScope> {};

TEST_P(FrameProgramOf, GradientIsTheDerivativeOfTheLagrangian) {
  const FrameProgram p = sample_program(GetParam());
  const InequalityLayout at(p);
  const ProgramVector v = sample_point(p), d = sample_direction(p);
  const VectorXd weights = VectorXd::LinSpaced(at.count, 0.1, 1.2);
  const double slope = dot(lagrangian_gradient(p, at, v, weights), d);
  const auto difference = [&](double h) {
    ProgramVector up = v, down = v;
    up.add(h, d);
    down.add(-h, d);
    return (lagrangian(p, at, up, weights) - lagrangian(p, at, down, weights)) / (2 * h);
  };
  const double coarse = std::abs(difference(2e-2) - slope), fine = std::abs(difference(1e-2) - slope);
  EXPECT_LT(fine, 1e-2 * std::abs(slope));
  EXPECT_LT(fine, 0.27 * coarse + 1e-10);
}

// Every coordinate of the program that may change.
std::vector<double*> coordinates(const FrameProgram& p, ProgramVector& v) {
  std::vector<double*> all;
  for (int j = 0; j < p.strut_count(); ++j)
    if (!p.area_is_given(j)) all.push_back(&v.areas[j]);
  for (int i = 0; i < p.node_count(); ++i)
    for (int axis = 0; axis < 3; ++axis) {
      if (p.moves[i]) all.push_back(&v.positions(axis, i));
      for (int k = 0; k < p.case_count() && !p.fixed[i][axis]; ++k) {
        all.push_back(&v.displacements[k](axis, i));
        all.push_back(&v.multipliers[k](axis, i));
      }
    }
  if (p.elastic != ElasticScope::kNone) all.push_back(&v.elastic);
  return all;
}

// The error of a central difference falls by four when the step is halved: along every single coordinate.
TEST_P(FrameProgramOf, GradientIsRightInEveryCoordinate) {
  const FrameProgram p = sample_program(GetParam());
  const InequalityLayout at(p);
  ProgramVector v = sample_point(p);
  const VectorXd weights = VectorXd::LinSpaced(at.count, 0.1, 1.2);
  ProgramVector gradient = lagrangian_gradient(p, at, v, weights);
  const std::vector<double*> points = coordinates(p, v), slopes = coordinates(p, gradient);
  ASSERT_EQ(points.size(), slopes.size());
  for (std::size_t q = 0; q < points.size(); ++q) {
    const double here = *points[q];
    const auto error = [&](double h) {
      *points[q] = here + h;
      const double up = lagrangian(p, at, v, weights);
      *points[q] = here - h;
      const double down = lagrangian(p, at, v, weights);
      *points[q] = here;
      return std::abs((up - down) / (2 * h) - *slopes[q]);
    };
    EXPECT_LT(error(1e-2), 0.27 * error(2e-2) + 1e-10) << "coordinate " << q;
  }
}

// Each inequality on its own, with the same check of the order.
TEST_P(FrameProgramOf, SlopesAreTheDerivativesOfInequalitiesAndObjective) {
  const FrameProgram p = sample_program(GetParam());
  const InequalityLayout at(p);
  const ProgramVector v = sample_point(p), d = sample_direction(p);
  const VectorXd slopes = inequality_slopes(p, at, v, d);
  const auto errors = [&](double h) {
    ProgramVector up = v, down = v;
    up.add(h, d);
    down.add(-h, d);
    VectorXd all(at.count + 1);
    all << (inequalities(p, at, up) - inequalities(p, at, down)) / (2 * h) - slopes,
        (objective(p, up) - objective(p, down)) / (2 * h) - objective_slope(p, v, d);
    return VectorXd(all.cwiseAbs());
  };
  const VectorXd coarse = errors(2e-2), fine = errors(1e-2);
  for (Eigen::Index i = 0; i < fine.size(); ++i) EXPECT_LT(fine[i], 0.27 * coarse[i] + 1e-11) << i;
}

// All equations of the perturbed KKT system, stacked.
VectorXd kkt_equations(const FrameProgram& p, const InequalityLayout& at, const Iterate& it, double mu) {
  const ProgramVector g = lagrangian_gradient(p, at, it.point, it.duals);
  std::vector<double> all(g.areas.data(), g.areas.data() + g.areas.size());
  all.insert(all.end(), g.positions.data(), g.positions.data() + g.positions.size());
  for (std::size_t k = 0; k < g.displacements.size(); ++k) {
    all.insert(all.end(), g.displacements[k].data(), g.displacements[k].data() + g.displacements[k].size());
    all.insert(all.end(), g.multipliers[k].data(), g.multipliers[k].data() + g.multipliers[k].size());
  }
  if (p.elastic != ElasticScope::kNone) all.push_back(g.elastic);
  const VectorXd c = inequalities(p, at, it.point) + it.slacks;
  const VectorXd z = it.duals.cwiseProduct(it.slacks).array() - mu;
  all.insert(all.end(), c.data(), c.data() + c.size());
  all.insert(all.end(), z.data(), z.data() + z.size());
  return VectorXd::Map(all.data(), static_cast<Eigen::Index>(all.size()));
}

TEST_P(FrameProgramOf, NewtonStepLowersEveryKktEquationAlike) {
  const FrameProgram p = sample_program(GetParam());
  const InequalityLayout at(p);
  const double mu = 0.1;
  Iterate it{sample_point(p), VectorXd::LinSpaced(at.count, 0.6, 1.4),
             VectorXd::LinSpaced(at.count, 1.5, 0.4)};
  KktSystem kkt(p, at);
  kkt.assemble(it, {});
  kkt.factorise();  // the step is the Newton step whatever the inertia is
  const NewtonStep direction = complete_step(p, at, it, mu, kkt.solve(it, mu));

  const VectorXd before = kkt_equations(p, at, it, mu);
  const auto remainder = [&](double h) {
    Iterate moved = it;
    moved.point.add(h, direction.point);
    moved.slacks += h * direction.slacks;
    moved.duals += h * direction.duals;
    return (kkt_equations(p, at, moved, mu) - (1 - h) * before).norm();
  };
  const double coarse = remainder(2e-4), fine = remainder(1e-4);
  EXPECT_LT(fine, 0.26 * coarse + 1e-10) << coarse << " -> " << fine;
  EXPECT_LT(fine, 1e-3 * before.norm());
}

// The Hessian in positions and the bilinear equilibrium are indefinite. Strong duals of the bounds and a
// strong regularisation make the signs right; multipliers that outweigh them make them wrong.
TEST_P(FrameProgramOf, InertiaIsRefusedWhereTheProgramCurvesDownAndAcceptedOnceRegularised) {
  const FrameProgram p = sample_program(GetParam());
  const InequalityLayout at(p);
  Iterate it{sample_point(p), VectorXd::Constant(at.count, 1.0), VectorXd::Constant(at.count, 1e-3)};
  for (NodeMatrix& multipliers : it.point.multipliers) multipliers *= 30;
  KktSystem kkt(p, at);
  kkt.assemble(it, {});
  EXPECT_FALSE(kkt.factorise());
  kkt.assemble(it, {1e4, 1e-8});
  EXPECT_TRUE(kkt.factorise());
}

INSTANTIATE_TEST_SUITE_P(Elastic, FrameProgramOf,
                         ::testing::Values(ElasticScope::kNone, ElasticScope::kLimits,
                                           ElasticScope::kBalance),
                         [](const auto& tested) {
                           return tested.param == ElasticScope::kNone     ? "none"
                                  : tested.param == ElasticScope::kLimits ? "limits"
                                                                          : "balance";
                         });

// minimise A subject to K(A) d = F and d <= 1: one strut along x, A = F l / limit.
TEST(InteriorPoint, OneStrutIsAsThickAsItsLimitAsks) {
  FrameProgram p;
  p.struts = {{0, 1}};
  p.fixed = {{true, true, true}, {false, true, true}};
  p.moves = {false, false};
  p.springs = {1.0, 0.9, 0.0};
  ProgramCase load{NodeMatrix::Zero(3, 2), 0.0};
  load.force(0, 1) = 0.6;
  p.cases = {load};
  p.lower = VectorXd::Constant(1, 0.01);
  p.upper = VectorXd::Constant(1, 10.0);
  p.squared_displacement_limit = 1;
  ProgramVector start;
  start.areas = VectorXd::Constant(1, 3.0);
  start.positions = NodeMatrix::Zero(3, 2);
  start.positions(0, 1) = 2;
  start.displacements = {NodeMatrix::Zero(3, 2)};
  start.multipliers = start.displacements;
  const InteriorPointResult result = solve_program(p, start, {});
  EXPECT_EQ(result.end, InteriorPointEnd::kOptimal);
  EXPECT_NEAR(result.point.areas[0], 0.6 * 2, 1e-6);
  EXPECT_NEAR(result.point.displacements[0](0, 1), 1, 1e-6);
}

}  // namespace
}  // namespace skinframe
