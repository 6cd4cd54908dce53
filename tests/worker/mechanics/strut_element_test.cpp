// SPDX-License-Identifier: GPL-3.0-or-later
// Every derivative against central differences, with the order of the error: halving the step must quarter
// it.
#include "worker/mechanics/strut_element.h"

#include <gtest/gtest.h>

#include <functional>

#include "worker/mechanics/strut_strain.h"

namespace skinframe {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

MatrixXd central_differences(const std::function<VectorXd(const VectorXd&)>& f, const VectorXd& x,
                             double step) {
  MatrixXd jacobian(f(x).size(), x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    VectorXd up = x, down = x;
    up[i] += step;
    down[i] -= step;
    jacobian.col(i) = (f(up) - f(down)) / (2 * step);
  }
  return jacobian;
}

// Exact for quadratics, second order otherwise.
void expect_derivative(const std::function<VectorXd(const VectorXd&)>& f, const MatrixXd& jacobian,
                       const VectorXd& x) {
  const double step = 1e-2;
  const double coarse = (central_differences(f, x, step) - jacobian).norm();
  const double fine = (central_differences(f, x, step / 2) - jacobian).norm();
  const double rounding = 1e-10 * (1 + jacobian.norm());
  EXPECT_LT(fine, 1e-3 * (1 + jacobian.norm()));
  EXPECT_LT(fine, 0.27 * coarse + rounding) << "not of second order: " << coarse << " -> " << fine;
}

StrutState unpack(const VectorXd& q) { return {q.segment<3>(0), q.segment<3>(3), q.segment<3>(6), q[9]}; }

VectorXd sample_state() {
  VectorXd q(10);
  q << 1.1, -0.7, 0.9, 0.3, -0.2, 0.5, -0.4, 0.8, 0.1, 0.6;
  return q;
}

class StrutElement : public ::testing::TestWithParam<ElementModel> {
 protected:
  StrutSprings springs_ = [] {
    Material m;
    m.tensile_modulus_mpa = 1.6;
    m.shear_modulus_mpa = 1.4;
    m.density_g_cm3 = 1e5;
    return strut_springs(GetParam(), m);
  }();
};

TEST_P(StrutElement, GradientIsTheDerivativeOfTheWork) {
  const VectorXd q = sample_state();
  expect_derivative([&](const VectorXd& x) { return VectorXd::Constant(1, strut_work(springs_, unpack(x))); },
                    strut_work_gradient(springs_, unpack(q)).transpose(), q);
}

TEST_P(StrutElement, HessianIsTheDerivativeOfTheGradient) {
  const VectorXd q = sample_state();
  const StrutHessian hessian = strut_work_hessian(springs_, unpack(q));
  expect_derivative([&](const VectorXd& x) -> VectorXd { return strut_work_gradient(springs_, unpack(x)); },
                    hessian, q);
  EXPECT_EQ((hessian - hessian.transpose()).norm(), 0);
}

TEST_P(StrutElement, WorkIsTheStiffnessBetweenDisplacementAndMultiplier) {
  const StrutState q = unpack(sample_state());
  EXPECT_NEAR(strut_work(springs_, q),
              q.delta.dot(strut_stiffness(springs_, q.e) * q.eta) + springs_.half_weight * q.e.norm() * q.s,
              1e-14);
}

INSTANTIATE_TEST_SUITE_P(Models, StrutElement, ::testing::Values(ElementModel::kPaper, ElementModel::kAxial),
                         [](const auto& tested) { return to_string(tested.param); });

TEST(StrutElement, AxialElementHasNoStiffnessAcross) {
  Material m;
  m.tensile_modulus_mpa = 1586;
  m.shear_modulus_mpa = 1387;
  const Eigen::Matrix3d b = strut_stiffness(strut_springs(ElementModel::kAxial, m), {20, 0, 0});
  EXPECT_NEAR(b(0, 0), 1586.0 / 20, 1e-12);
  EXPECT_EQ(b(1, 1), 0);
  EXPECT_EQ(b(2, 2), 0);
}

class StrutStrain : public ::testing::TestWithParam<StrainKind> {};

TEST_P(StrutStrain, DerivativesAreThoseOfTheSquaredStrain) {
  VectorXd q(6);
  q << 1.1, -0.7, 0.9, 0.3, -0.2, 0.5;
  const StrainKind kind = GetParam();
  expect_derivative(
      [&](const VectorXd& x) {
        return VectorXd::Constant(1, squared_strain(kind, x.head<3>(), x.tail<3>()));
      },
      squared_strain_gradient(kind, q.head<3>(), q.tail<3>()).transpose(), q);
  expect_derivative(
      [&](const VectorXd& x) -> VectorXd { return squared_strain_gradient(kind, x.head<3>(), x.tail<3>()); },
      squared_strain_hessian(kind, q.head<3>(), q.tail<3>()), q);
}

INSTANTIATE_TEST_SUITE_P(Kinds, StrutStrain, ::testing::Values(StrainKind::kAxial, StrainKind::kShear),
                         [](const auto& tested) {
                           return tested.param == StrainKind::kAxial ? "axial" : "shear";
                         });

TEST(StrutStrain, SplitsAStretchAndAShear) {
  const Vector3d e(10, 0, 0);
  EXPECT_NEAR(squared_strain(StrainKind::kAxial, e, {0.02, 0, 0}), 4e-6, 1e-18);
  EXPECT_NEAR(squared_strain(StrainKind::kShear, e, {0.02, 0, 0}), 0, 1e-18);
  EXPECT_NEAR(squared_strain(StrainKind::kShear, e, {0.02, 0.03, 0.04}), 25e-6, 1e-18);
}

}  // namespace
}  // namespace skinframe
