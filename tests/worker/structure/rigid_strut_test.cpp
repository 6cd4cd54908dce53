// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/structure/rigid_strut.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numbers>

#include "tests/worker/structure/derivatives.h"

namespace skinframe {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using test::expect_derivative;

const ElasticMaterial kPa{1586, 0.35};

RigidStrut internal_strut() {
  return {StrutShape::kFullDisc,
          {Vector3d(1, 2, 3), Vector3d(9, -4, 11)},
          {Vector3d(0.6, 0, 0.8), Vector3d::Zero()},
          0.5,
          1.3};
}
RigidStrut skin_strut() {
  return {StrutShape::kHalfDisc,
          {Vector3d(1, 2, 3), Vector3d(8, 0.5, 3.7)},
          {Vector3d(0.1, 0.2, -1).normalized(), Vector3d(-0.15, 0.1, -1).normalized()},
          0.5,
          0.8};
}

class EitherStrut : public testing::TestWithParam<RigidStrut> {};
INSTANTIATE_TEST_SUITE_P(FullAndHalfDisc, EitherStrut, testing::Values(internal_strut(), skin_strut()));

TEST_P(EitherStrut, RigidMotionsStoreNoEnergy) {
  const RigidStrut s = GetParam();
  const StrutMatrix k = rigid_strut_stiffness(s, kPa);
  for (int m = 0; m < 6; ++m) {
    StrutVector d = StrutVector::Zero();
    for (int i = 0; i < 2; ++i) {
      if (m < 3) {
        d[6 * i + m] = 1;
      } else {
        const Vector3d turn = Vector3d::Unit(m - 3);
        d.segment<3>(6 * i) = turn.cross(s.node_mm[i]);
        d.segment<3>(6 * i + 3) = turn;
      }
    }
    EXPECT_LT((k * d).cwiseAbs().maxCoeff(), 1e-10 * k.cwiseAbs().maxCoeff()) << m;
  }
}

TEST_P(EitherStrut, StiffnessIsSymmetricWithSixZeroEigenvaluesAndNoneBelow) {
  const StrutMatrix k = rigid_strut_stiffness(GetParam(), kPa);
  EXPECT_LT((k - k.transpose()).cwiseAbs().maxCoeff(), 1e-12 * k.cwiseAbs().maxCoeff());
  const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(k).eigenvalues();
  EXPECT_GT(values[0], -1e-11 * values[11]);
  EXPECT_LT(values[5], 1e-11 * values[11]);
  EXPECT_GT(values[6], 1e-7 * values[11]);
}

TEST_P(EitherStrut, FirstAndSecondDerivativeInRadius) {
  const auto at = [&](double step) {
    RigidStrut s = GetParam();
    s.radius_mm += step;
    return s;
  };
  expect_derivative([&](double h) { return rigid_strut_stiffness(at(h), kPa); },
                    rigid_strut_stiffness_d_radius(GetParam(), kPa), 1e-2);
  expect_derivative([&](double h) { return rigid_strut_stiffness_d_radius(at(h), kPa); },
                    rigid_strut_stiffness_d2_radius(GetParam(), kPa), 1e-2);
}

TEST_P(EitherStrut, DerivativeInTheArm) {
  expect_derivative(
      [&](double h) {
        RigidStrut s = GetParam();
        s.arm_mm += h;
        return rigid_strut_stiffness(s, kPa);
      },
      rigid_strut_stiffness_d_arm(GetParam(), kPa), 1e-2);
}

TEST_P(EitherStrut, DerivativesInThePositions) {
  const auto derivatives = rigid_strut_stiffness_d_position(GetParam(), kPa);
  for (int i = 0; i < 6; ++i)
    expect_derivative(
        [&](double h) {
          RigidStrut s = GetParam();
          s.node_mm[i / 3][i % 3] += h;
          return rigid_strut_stiffness(s, kPa);
        },
        derivatives[i], 1e-2);
}

// A beam's compliance against Euler, Bernoulli and Timoshenko, in any direction of space: one element is
// exact.
TEST(RigidStrut, ObliqueCantileverIsTimoshenkosAndSlenderIsEulers) {
  const Vector3d along = Vector3d(0.6, 0.64, 0.48);
  const Vector3d across = along.cross(Vector3d::UnitZ()).normalized();
  for (const double l : {4.0, 400.0}) {
    RigidStrut s;
    s.node_mm[1] = l * along;
    s.radius_mm = 2;
    const StrutMatrix k = rigid_strut_stiffness(s, kPa);
    Eigen::Matrix<double, 6, 1> f = Eigen::Matrix<double, 6, 1>::Zero();
    f.head<3>() = across;
    const Eigen::Matrix<double, 6, 1> d = k.block<6, 6>(6, 6).ldlt().solve(f);
    const double inertia = std::numbers::pi * 4, area = std::numbers::pi * 4;
    const double euler = l * l * l / (3 * 1586 * inertia);
    const double g = 1586 / 2.7, coefficient = 6 * 1.35 / 9.1;
    EXPECT_NEAR(d.head<3>().dot(across), euler + l / (coefficient * g * area), 1e-9 * euler);
    EXPECT_NEAR(d.tail<3>().dot(along.cross(across)), l * l / (2 * 1586 * inertia), 1e-9 * euler);
    if (l > 100) {
      EXPECT_NEAR(d.head<3>().dot(across) / euler, 1, 1e-3);
    }
  }
}

TEST(RigidStrut, TwistIsSaintVenants) {
  RigidStrut s;
  s.node_mm[1] = {0, 0, 10};
  s.radius_mm = 1;
  const StrutMatrix k = rigid_strut_stiffness(s, kPa);
  EXPECT_NEAR(k(5, 5), 1586 / 2.7 * std::numbers::pi / 2 / 10, 1e-9);
}

// By definition of the half disc, integrated numerically.
TEST(StrutSection, HalfDiscIsTheIntegralOverTheHalfDisc) {
  const double r = 1.7;
  double area = 0, first = 0, out = 0, in = 0;
  constexpr int kCells = 2000;
  for (int i = 0; i < kCells; ++i) {
    const double y = r * (i + 0.5) / kCells, half = std::sqrt(r * r - y * y), h = r / kCells;
    area += 2 * half * h;
    first += 2 * half * h * y;
    out += 2 * half * h * y * y;
    in += 2 * half * half * half / 3 * h;
  }
  const auto s = section_of(StrutShape::kHalfDisc, r, 0.35);
  EXPECT_NEAR(s.area, area, 1e-4 * area);
  EXPECT_NEAR(kHalfDiscCentroid * r, first / area, 1e-4);
  EXPECT_NEAR(s.i_out, out - first * first / area, 1e-3 * s.i_out);
  EXPECT_NEAR(s.i_in, in, 1e-4 * in);
}

TEST_P(EitherStrut, WeightIsThatOfItsVolumeAndActsAtTheAxisMiddle) {
  const RigidStrut s = GetParam();
  const double density = 1e-5;
  const StrutVector w = rigid_strut_weight(s, kPa, density);
  const double area = section_of(s.shape, s.radius_mm, 0.35).area;
  const double weight = density * area * rigid_strut_length_mm(s);
  EXPECT_NEAR(w[2] + w[8], -weight, 1e-12 * weight);
  const double reach = s.arm_mm + (s.shape == StrutShape::kHalfDisc ? kHalfDiscCentroid * s.radius_mm : 0);
  Vector3d moment = Vector3d::Zero(), middle = Vector3d::Zero();
  for (int i = 0; i < 2; ++i) {
    moment += s.node_mm[i].cross(Vector3d(w.segment<3>(6 * i))) + w.segment<3>(6 * i + 3);
    middle += (s.node_mm[i] + reach * s.arm[i]) / 2;
  }
  EXPECT_LT((moment - middle.cross(Vector3d(0, 0, -weight))).norm(), 1e-9 * weight * middle.norm());
}

TEST(RigidStrut, StressOfAPulledAndABentStrut) {
  RigidStrut s;
  s.node_mm[1] = {10, 0, 0};
  s.radius_mm = 1;
  StrutVector d = StrutVector::Zero();
  d[6] = 0.1;
  const StrutStress pulled = rigid_strut_stress(s, kPa, d);
  EXPECT_NEAR(pulled.axial_force_n, 15.86 * std::numbers::pi, 1e-9);
  EXPECT_NEAR(pulled.von_mises_mpa, 15.86, 1e-9);
  d.setZero();
  d[11] = 0.01;  // pure bending: M = E I kappa, with the end moved along the arc
  d[7] = 0.05;
  EXPECT_NEAR(rigid_strut_stress(s, kPa, d).von_mises_mpa, 1586 * 0.001, 1e-9);
}

}  // namespace
}  // namespace skinframe
