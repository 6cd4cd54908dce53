// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/structure/shell_triangle.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "tests/worker/structure/derivatives.h"
#include "tests/worker/structure/grids.h"

namespace skinframe {
namespace {

using Eigen::Vector3d;
using test::expect_derivative;

const ElasticMaterial kPa{1586, 0.35};

ShellTriangle triangle() { return {{Vector3d(0.2, 0.1, 1), Vector3d(6, 1, 2), Vector3d(2, 5, -1)}, 1.1}; }

TEST(ShellTriangle, RigidMotionsStoreNoEnergy) {
  const ShellTriangle s = triangle();
  const ShellMatrix k = shell_stiffness(s, kPa);
  for (int m = 0; m < 6; ++m) {
    ShellVector d = ShellVector::Zero();
    for (int i = 0; i < 3; ++i) {
      if (m < 3) {
        d[6 * i + m] = 1;
      } else {
        const Vector3d turn = Vector3d::Unit(m - 3);
        d.segment<3>(6 * i) = turn.cross(s.corner_mm[i]);
        d.segment<3>(6 * i + 3) = turn;
      }
    }
    EXPECT_LT((k * d).cwiseAbs().maxCoeff(), 1e-11 * k.cwiseAbs().maxCoeff()) << m;
  }
}

TEST(ShellTriangle, StiffnessIsSymmetricWithSixZeroEigenvaluesAndNoneBelow) {
  const ShellMatrix k = shell_stiffness(triangle(), kPa);
  EXPECT_LT((k - k.transpose()).cwiseAbs().maxCoeff(), 1e-12 * k.cwiseAbs().maxCoeff());
  const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(k).eigenvalues();
  EXPECT_GT(values[0], -1e-11 * values[17]);
  EXPECT_LT(values[5], 1e-11 * values[17]);
  EXPECT_GT(values[6], 1e-6 * values[17]);
}

TEST(ShellTriangle, DoesNotDependOnWhichCornerComesFirst) {
  const ShellTriangle s = triangle();
  const ShellTriangle turned{{s.corner_mm[1], s.corner_mm[2], s.corner_mm[0]}, s.thickness_mm};
  const ShellMatrix k = shell_stiffness(s, kPa), t = shell_stiffness(turned, kPa);
  for (int i = 0; i < 18; ++i)
    for (int j = 0; j < 18; ++j) EXPECT_NEAR(t(i, j), k((i + 6) % 18, (j + 6) % 18), 1e-9);
}

TEST(ShellTriangle, FirstAndSecondDerivativeInThickness) {
  const auto at = [](double h) {
    ShellTriangle s = triangle();
    s.thickness_mm += h;
    return s;
  };
  expect_derivative([&](double h) { return shell_stiffness(at(h), kPa); },
                    shell_stiffness_d_thickness(triangle(), kPa), 1e-2);
  expect_derivative([&](double h) { return shell_stiffness_d_thickness(at(h), kPa); },
                    shell_stiffness_d2_thickness(triangle(), kPa), 1e-2);
}

TEST(ShellTriangle, DerivativesInThePositions) {
  const auto derivatives = shell_stiffness_d_position(triangle(), kPa);
  for (int i = 0; i < 9; ++i)
    expect_derivative(
        [&](double h) {
          ShellTriangle s = triangle();
          s.corner_mm[i / 3][i % 3] += h;
          return shell_stiffness(s, kPa);
        },
        derivatives[i], 1e-2);
}

// A patch of distorted triangles whose rim is moved as a field of constant strain asks: inside, the same
// field.
class Patch : public testing::Test {
 protected:
  void SetUp() override {
    s_.material = {1000, 0.3};
    const Eigen::Vector2d at[] = {{0, 0}, {10, 0}, {10, 10}, {0, 10}, {3, 2.5}, {7.5, 3}, {6, 7.8}, {2.2, 6}};
    for (const auto& p : at) s_.nodes_mm.push_back(turn_ * Vector3d(p.x(), p.y(), 0));
    for (const auto& t : {std::array{0, 1, 5}, std::array{0, 5, 4}, std::array{1, 2, 5}, std::array{2, 6, 5},
                          std::array{2, 3, 6}, std::array{3, 7, 6}, std::array{3, 0, 7}, std::array{0, 4, 7},
                          std::array{4, 5, 6}, std::array{4, 6, 7}})
      s_.shells.push_back({t, 0.5});
    s_.held.assign(8, kFree);
    for (int i = 0; i < 4; ++i) s_.held[i] = kClamped;
  }
  // Where the rim has the field: K_ff d_f = -K_fr d_r, by a dense solve of the element matrices.
  void expect_field(const std::function<Eigen::Matrix<double, 6, 1>(double, double)>& field) {
    Eigen::MatrixXd k = Eigen::MatrixXd::Zero(48, 48);
    for (std::size_t t = 0; t < s_.shells.size(); ++t) {
      const ShellMatrix e = shell_stiffness(s_.shell(t), s_.material);
      for (int i = 0; i < 18; ++i)
        for (int j = 0; j < 18; ++j)
          k(6 * s_.shells[t].nodes[i / 6] + i % 6, 6 * s_.shells[t].nodes[j / 6] + j % 6) += e(i, j);
    }
    Eigen::VectorXd d(48);
    for (int i = 0; i < 8; ++i) {
      const Vector3d p = turn_.transpose() * s_.nodes_mm[i];
      const auto f = field(p.x(), p.y());
      d.segment<3>(6 * i) = turn_ * f.head<3>();
      d.segment<3>(6 * i + 3) = turn_ * f.tail<3>();
    }
    const Eigen::VectorXd inside =
        k.bottomRightCorner(24, 24).ldlt().solve(Eigen::VectorXd(-k.bottomLeftCorner(24, 24) * d.head(24)));
    EXPECT_LT((inside - d.tail(24)).cwiseAbs().maxCoeff(), 1e-9 * d.cwiseAbs().maxCoeff());
    displacement_ = d;
  }
  Structure s_;
  Eigen::Matrix3d turn_ = Eigen::AngleAxisd(0.7, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  Eigen::VectorXd displacement_;
};

TEST_F(Patch, ConstantMembraneStrainIsExact) {
  expect_field([](double x, double y) {
    Eigen::Matrix<double, 6, 1> d;
    d << 1e-3 * x + 4e-4 * y, 8e-4 * x - 5e-4 * y, 0, 0, 0, 0.5 * (8e-4 - 4e-4);
    return d;
  });
  for (std::size_t t = 0; t < s_.shells.size(); ++t) {
    const ShellStress stress =
        shell_stress(s_.shell(t), s_.material, freedoms_of(s_.shells[t], displacement_));
    const double c = 1000 / 0.91, xx = c * (1e-3 - 0.3 * 5e-4), yy = c * (0.3 * 1e-3 - 5e-4),
                 xy = 1000 / 2.6 * 1.2e-3;
    EXPECT_NEAR(stress.von_mises_mpa, std::sqrt(xx * xx - xx * yy + yy * yy + 3 * xy * xy), 1e-9);
    EXPECT_LT(stress.bending_mpa.norm(), 1e-9);
  }
}

TEST_F(Patch, ConstantCurvatureIsExact) {
  expect_field([](double x, double y) {
    Eigen::Matrix<double, 6, 1> d;  // w = (a x^2 + b y^2) / 2 + c x y
    d << 0, 0, 1e-3 * x * x / 2 - 4e-4 * y * y / 2 + 6e-4 * x * y, -4e-4 * y + 6e-4 * x,
        -(1e-3 * x + 6e-4 * y), 0;
    return d;
  });
  for (std::size_t t = 0; t < s_.shells.size(); ++t) {
    const ShellStress stress =
        shell_stress(s_.shell(t), s_.material, freedoms_of(s_.shells[t], displacement_));
    const double c = 0.25 * 1000 / 0.91, xx = c * (1e-3 - 0.3 * 4e-4), yy = c * (0.3 * 1e-3 - 4e-4),
                 xy = 0.25 * 1000 / 2.6 * 1.2e-3;
    EXPECT_NEAR(stress.von_mises_mpa, std::sqrt(xx * xx - xx * yy + yy * yy + 3 * xy * xy), 1e-9);
    EXPECT_LT(stress.membrane_mpa.norm(), 1e-9);
  }
}

}  // namespace
}  // namespace skinframe
