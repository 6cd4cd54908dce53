// SPDX-License-Identifier: GPL-3.0-or-later
// What an optimiser is told of the valid model's elements: every derivative against central differences of
// checked order, of elements and of a whole structure's answer.
#include "worker/structure/element_work.h"

#include <gtest/gtest.h>

#include "tests/worker/structure/derivatives.h"
#include "tests/worker/structure/grids.h"

namespace skinframe {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using test::expect_derivative;

const ElementSetting kSetting{{1.586, 0.35}, 0.02};  // numbers of one order, so that all of them count

// Reproducible and without a pattern.
template <class Vector>
Vector spread(double seed) {
  Vector v;
  for (int i = 0; i < v.size(); ++i) v[i] = std::sin(seed + 1.7 * i) + 0.2 * std::cos(3 * seed + i * i);
  return v;
}

struct PosedStrut {
  RigidStrut strut;
  StrutMotion motion;
};

RigidStrut half_disc() {
  return {StrutShape::kHalfDisc,
          {Vector3d(1, 2, 3), Vector3d(8, 0.5, 3.7)},
          {Vector3d(0.1, 0.2, -1).normalized(), Vector3d(-0.15, 0.1, -1).normalized()},
          0.5,
          0.8};
}
RigidStrut full_disc() {
  return {StrutShape::kFullDisc,
          {Vector3d(1, 2, 3), Vector3d(9, -4, 11)},
          {Vector3d(0.6, 0, 0.8), Vector3d::Zero()},
          0.5,
          1.3};
}

class StrutWork : public testing::TestWithParam<RigidStrut> {
 protected:
  StrutWork() : at_{GetParam(), {spread<StrutVector>(1), spread<StrutVector>(2), 1}} {}

  // The variable of that index moved by h.
  PosedStrut moved(int i, double h) const {
    PosedStrut p = at_;
    if (i < kStrutArm)
      p.strut.node_mm[i / 3][i % 3] += h;
    else if (i == kStrutArm)
      p.strut.arm_mm += h;
    else if (i == kStrutRadius)
      p.strut.radius_mm += h;
    else if (i < kStrutMultiplier)
      p.motion.d[i - kStrutMotion] += h;
    else
      p.motion.lambda[i - kStrutMultiplier] += h;
    return p;
  }
  PosedStrut at_;
};
INSTANTIATE_TEST_SUITE_P(FullAndHalfDisc, StrutWork, testing::Values(full_disc(), half_disc()));

TEST_P(StrutWork, IsTheStiffnessBetweenMotionAndMultiplierLessTheWeight) {
  const StrutMotion& m = at_.motion;
  const StrutVector rest = rigid_strut_stiffness(at_.strut, kSetting.material) * m.d -
                           rigid_strut_weight(at_.strut, kSetting.material, kSetting.weight_density_n_mm3);
  EXPECT_NEAR(rigid_strut_work(kSetting, at_.strut, m), m.lambda.dot(rest), 1e-12 * rest.norm());
}

TEST_P(StrutWork, GradientIsTheDerivativeOfTheWork) {
  const StrutWorkGradient g = rigid_strut_work_gradient(kSetting, at_.strut, at_.motion);
  for (int i = 0; i < g.size(); ++i)
    expect_derivative(
        [&](double h) {
          const PosedStrut p = moved(i, h);
          return Eigen::MatrixXd::Constant(1, 1, rigid_strut_work(kSetting, p.strut, p.motion));
        },
        g.segment<1>(i), 1e-2);
}

TEST_P(StrutWork, HessianIsTheDerivativeOfTheGradientAndSymmetric) {
  const StrutWorkHessian h = rigid_strut_work_hessian(kSetting, at_.strut, at_.motion);
  EXPECT_LT((h - h.transpose()).cwiseAbs().maxCoeff(), 1e-12 * h.cwiseAbs().maxCoeff());
  for (int i = 0; i < h.cols(); ++i)
    expect_derivative(
        [&](double step) {
          const PosedStrut p = moved(i, step);
          return Eigen::MatrixXd(rigid_strut_work_gradient(kSetting, p.strut, p.motion));
        },
        h.col(i), 1e-2);
}

struct PosedShell {
  ShellTriangle shell{{Vector3d(0.2, 0.1, 1), Vector3d(6, 1, 2), Vector3d(2, 5, -1)}, 1.1};
  ShellMotion motion{spread<ShellVector>(3), spread<ShellVector>(4), 1};
};

PosedShell moved_shell(int i, double h) {
  PosedShell p;
  if (i == 0)
    p.shell.thickness_mm += h;
  else if (i < kShellMultiplier)
    p.motion.d[i - kShellMotion] += h;
  else
    p.motion.lambda[i - kShellMultiplier] += h;
  return p;
}

TEST(ShellWork, GradientIsTheDerivativeOfTheWork) {
  const PosedShell at;
  const ShellWorkGradient g = shell_work_gradient(kSetting, at.shell, at.motion);
  const auto positions = shell_work_d_position(kSetting, at.shell, at.motion);
  const auto work = [](const PosedShell& p) {
    return Eigen::MatrixXd::Constant(1, 1, shell_work(kSetting, p.shell, p.motion));
  };
  for (int i = 0; i < g.size(); ++i)
    expect_derivative([&](double h) { return work(moved_shell(i, h)); }, g.segment<1>(i), 1e-2);
  for (int i = 0; i < 9; ++i)
    expect_derivative(
        [&](double h) {
          PosedShell p;
          p.shell.corner_mm[i / 3][i % 3] += h;
          return work(p);
        },
        positions.segment<1>(i), 1e-2);
}

TEST(ShellWork, HessianIsTheDerivativeOfTheGradientAndSymmetric) {
  const PosedShell at;
  const ShellWorkHessian h = shell_work_hessian(kSetting, at.shell, at.motion);
  EXPECT_LT((h - h.transpose()).cwiseAbs().maxCoeff(), 1e-12 * h.cwiseAbs().maxCoeff());
  for (int i = 0; i < h.cols(); ++i)
    expect_derivative(
        [&](double step) {
          const PosedShell p = moved_shell(i, step);
          return Eigen::MatrixXd(shell_work_gradient(kSetting, p.shell, p.motion));
        },
        h.col(i), 1e-2);
}

// A bent plate with a rib below it and a pillar on it, its weight and a push on the pillar.
class WholeStructure : public testing::Test {
 protected:
  WholeStructure() {
    test::ShellGrid grid = test::shell_grid(4, 2, 1.2, {1586, 0.35}, true, [](double u, double v) {
      return Vector3d(40 * u, 25 * v, 6 * std::sin(2 * u + v));
    });
    s_ = grid.structure;
    s_.weight_density_n_mm3 = 1e-3;
    for (int i = 0; i < 4; ++i) {
      StructureStrut rib;
      rib.nodes = {grid.node(i, 1), grid.node(i + 1, 1)};
      rib.shape = StrutShape::kHalfDisc;
      rib.arm = {Vector3d(0.2, 0.1, -1).normalized(), Vector3d(0.15, 0.1, -1).normalized()};
      rib.arm_mm = 0.6;
      rib.radius_mm = 0.9;
      s_.struts.push_back(rib);
    }
    s_.nodes_mm.push_back({35, 12, 30});
    StructureStrut pillar;
    pillar.nodes = {grid.node(3, 1), static_cast<int>(s_.nodes_mm.size()) - 1};
    pillar.radius_mm = 1.5;
    s_.struts.push_back(pillar);
    s_.held.push_back(kFree);
    for (int j = 0; j <= 2; ++j) s_.held[grid.node(0, j)] = kClamped;
    push_ = VectorXd::Zero(6 * static_cast<Eigen::Index>(s_.nodes_mm.size()));
    push_.tail<6>() << 3, 5, -7, 11, -2, 4;
  }

  VectorXd answer(const Structure& s) const { return test::factorised(s).solve(push_ + self_weight_n(s)); }
  // The push's work, a response that is linear in the answer.
  Eigen::MatrixXd response(const Structure& s) const {
    return Eigen::MatrixXd::Constant(1, 1, push_.dot(answer(s)));
  }

  Structure s_;
  VectorXd push_;
};

TEST_F(WholeStructure, MultipliersMakeTheGradientThatOfAResponse) {
  constexpr double kStep = 0.05;  // mm: well above what is left of ten digits after a solve
  const VectorXd lambda = -VectorXd(test::factorised(s_).solve(push_));
  const DesignGradient g = work_gradient(s_, answer(s_), lambda, 1);
  for (const std::size_t j : {std::size_t{0}, std::size_t{2}, std::size_t{4}}) {
    expect_derivative(
        [&](double h) {
          Structure s = s_;
          s.struts[j].radius_mm += h;
          return response(s);
        },
        g.radius.segment<1>(static_cast<Eigen::Index>(j)), kStep);
  }
  expect_derivative(
      [&](double h) {
        Structure s = s_;
        s.struts[1].arm_mm += h;
        return response(s);
      },
      g.arm.segment<1>(1), kStep);
  for (const std::size_t i : {std::size_t{0}, std::size_t{7}, std::size_t{15}})
    expect_derivative(
        [&](double h) {
          Structure s = s_;
          s.shells[i].thickness_mm += h;
          return response(s);
        },
        g.thickness.segment<1>(static_cast<Eigen::Index>(i)), kStep);
  for (const int node : {4, 7, static_cast<int>(s_.nodes_mm.size()) - 1})
    for (int k = 0; k < 3; ++k)
      expect_derivative(
          [&](double h) {
            Structure s = s_;
            s.nodes_mm[node][k] += h;
            return response(s);
          },
          g.position_mm.block<1, 1>(k, node), kStep);
}

TEST_F(WholeStructure, RowsOfEquilibriumAreTheElementsGradientsInTheMultipliers) {
  const ElementSetting setting{s_.material, s_.weight_density_n_mm3};
  const VectorXd d = answer(s_), none = VectorXd::Zero(d.size());
  VectorXd rest = -push_;
  for (std::size_t i = 0; i < s_.shells.size(); ++i) {
    const auto g = shell_work_gradient(setting, s_.shell(i),
                                       {freedoms_of(s_.shells[i], d), freedoms_of(s_.shells[i], none), 1});
    for (int k = 0; k < 3; ++k)
      rest.segment<6>(6 * s_.shells[i].nodes[k]) += g.segment<6>(kShellMultiplier + 6 * k);
  }
  for (std::size_t j = 0; j < s_.struts.size(); ++j) {
    const auto g = rigid_strut_work_gradient(
        setting, s_.strut(j), {freedoms_of(s_.struts[j], d), freedoms_of(s_.struts[j], none), 1});
    for (int k = 0; k < 2; ++k)
      rest.segment<6>(6 * s_.struts[j].nodes[k]) += g.segment<6>(kStrutMultiplier + 6 * k);
  }
  for (std::size_t i = 0; i < s_.nodes_mm.size(); ++i)
    for (int k = 0; k < 6; ++k)
      if (!s_.held[i][k]) {
        EXPECT_NEAR(rest[6 * static_cast<Eigen::Index>(i) + k], 0, 1e-8 * push_.norm()) << i << " " << k;
      }
}

TEST_F(WholeStructure, TurningAllOfItLeavesTheWorkAndTurnsItsSlopes) {
  const VectorXd d = answer(s_), lambda = d;
  s_.weight_density_n_mm3 = 0;  // which way down is would not turn with it
  const DesignGradient g = work_gradient(s_, d, lambda, 1);
  for (const Vector3d& axis : {Vector3d(1, 0, 0), Vector3d(0, 1, 0), Vector3d(3, -2, 5)}) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.1, axis.normalized()).toRotationMatrix();
    Structure s = s_;
    for (Vector3d& p : s.nodes_mm) p = Vector3d(turn * p);
    for (StructureStrut& strut : s.struts)
      for (Vector3d& arm : strut.arm) arm = Vector3d(turn * arm);
    VectorXd turned = d;
    for (Eigen::Index i = 0; i < d.size(); i += 3) turned.segment<3>(i) = turn * d.segment<3>(i);
    const DesignGradient t = work_gradient(s, turned, turned, 1);
    EXPECT_LT((t.radius - g.radius).norm(), 1e-9 * g.radius.norm());
    EXPECT_LT((t.arm - g.arm).norm(), 1e-9 * g.arm.norm());
    EXPECT_LT((t.thickness - g.thickness).norm(), 1e-9 * g.thickness.norm());
    EXPECT_LT((t.position_mm - turn * g.position_mm).norm(), 1e-9 * g.position_mm.norm());
  }
}

}  // namespace
}  // namespace skinframe
