// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/structure/element_work.h"

#include <Eigen/Geometry>

#include "worker/structure/strut_formula.h"

namespace skinframe {
namespace {

using namespace strut_formula;
using Eigen::Vector3d;

constexpr int kDesign = 8;  // of a strut
using Slope = Gradient<kDesign>;
using Bend = Jet<Slope, kDesign>;  // value, first and second derivatives

// The strut's design as variables of T, seeded by `variable_at(value, index)`.
template <class T, class Seed>
Variables<T> seeded(const RigidStrut& s, Seed variable_at) {
  Variables<T> x;
  for (int i = 0; i < 6; ++i) x.node[i / 3][i % 3] = variable_at(s.node_mm[i / 3][i % 3], i);
  x.arm_mm = variable_at(s.arm_mm, kStrutArm);
  x.radius_mm = variable_at(s.radius_mm, kStrutRadius);
  return x;
}

Bend bend_variable(double value, int index) {
  Bend out(value);
  out.v.d[index] = 1.0;
  out.d[index].v = 1.0;
  return out;
}

template <class T>
struct Posed {
  Axis<T> axis;
  StrutSection<T> section;
};

template <class T>
Posed<T> posed(const ElementSetting& setting, const RigidStrut& s, const Variables<T>& x) {
  return {axis_of(s, x), section_of(s.shape, x.radius_mm, setting.material.poisson_ratio)};
}

// K d, without K.
template <class T>
Vector12<T> force(const ElementSetting& setting, const Posed<T>& p, const StrutVector& d) {
  const Matrix12<T> to_axis = carry(p.axis);
  const Vector12<T> moved = to_axis * d.cast<T>();
  const Vector12<T> local = straight_stiffness(p.section, p.axis.length, setting.material) * moved;
  return to_axis.transpose() * local;
}

template <class T>
Vector12<T> out_of_balance(const ElementSetting& setting, const Posed<T>& p, const StrutMotion& m) {
  const Vector12<T> f = weight(p.axis, p.section.area, m.gravity * setting.weight_density_n_mm3);
  return force(setting, p, m.d) - f;
}

template <class T>
T work(const ElementSetting& setting, const Posed<T>& p, const StrutMotion& m) {
  const Vector12<T> rest = out_of_balance(setting, p, m);
  T sum(0.0);
  for (int i = 0; i < 12; ++i) sum += T(m.lambda[i]) * rest[i];
  return sum;
}

// Third of the shell's weight at each corner, downwards.
double weight_third_n(const ElementSetting& setting, const ShellTriangle& s, double gravity) {
  return gravity * setting.weight_density_n_mm3 * s.thickness_mm * shell_area_mm2(s) / 3;
}

ShellVector shell_weight(double third_n) {
  ShellVector f = ShellVector::Zero();
  for (int i = 0; i < 3; ++i) f[6 * i + 2] = -third_n;
  return f;
}

}  // namespace

double rigid_strut_work(const ElementSetting& setting, const RigidStrut& s, const StrutMotion& m) {
  return work(setting, posed(setting, s, values_of(s)), m);
}

StrutWorkGradient rigid_strut_work_gradient(const ElementSetting& setting, const RigidStrut& s,
                                            const StrutMotion& m) {
  const auto p = posed(setting, s, seeded<Slope>(s, variable<kDesign>));
  const auto rest = out_of_balance(setting, p, m);
  StrutWorkGradient g = StrutWorkGradient::Zero();
  for (int i = 0; i < 12; ++i) {
    g[kStrutMultiplier + i] = rest[i].v;
    for (int k = 0; k < kDesign; ++k) g[k] += m.lambda[i] * rest[i].d[k];
  }
  g.segment<12>(kStrutMotion) = force(setting, posed(setting, s, values_of(s)), m.lambda);
  return g;
}

StrutWorkHessian rigid_strut_work_hessian(const ElementSetting& setting, const RigidStrut& s,
                                          const StrutMotion& m) {
  StrutWorkHessian h = StrutWorkHessian::Zero();
  const Bend w = work(setting, posed(setting, s, seeded<Bend>(s, bend_variable)), m);
  const auto slopes = posed(setting, s, seeded<Slope>(s, variable<kDesign>));
  const auto in_d = force(setting, slopes, m.lambda), in_lambda = out_of_balance(setting, slopes, m);
  for (int k = 0; k < kDesign; ++k) {
    for (int j = 0; j < kDesign; ++j) h(k, j) = w.d[std::max(j, k)].d[std::min(j, k)];
    for (int i = 0; i < 12; ++i) {
      h(k, kStrutMotion + i) = h(kStrutMotion + i, k) = in_d[i].d[k];
      h(k, kStrutMultiplier + i) = h(kStrutMultiplier + i, k) = in_lambda[i].d[k];
    }
  }
  const StrutMatrix stiffness = rigid_strut_stiffness(s, setting.material);
  h.block<12, 12>(kStrutMotion, kStrutMultiplier) = stiffness.transpose();
  h.block<12, 12>(kStrutMultiplier, kStrutMotion) = stiffness;
  return h;
}

double shell_work(const ElementSetting& setting, const ShellTriangle& s, const ShellMotion& m) {
  return m.lambda.dot(shell_stiffness(s, setting.material) * m.d -
                      shell_weight(weight_third_n(setting, s, m.gravity)));
}

ShellWorkGradient shell_work_gradient(const ElementSetting& setting, const ShellTriangle& s,
                                      const ShellMotion& m) {
  const ShellMatrix k = shell_stiffness(s, setting.material);
  const ShellMatrix slope = shell_stiffness_d_thickness(s, setting.material);
  const ShellVector f = shell_weight(weight_third_n(setting, s, m.gravity));
  ShellWorkGradient g;
  g << m.lambda.dot(slope * m.d - f / s.thickness_mm), k * m.lambda, k * m.d - f;
  return g;
}

ShellWorkHessian shell_work_hessian(const ElementSetting& setting, const ShellTriangle& s,
                                    const ShellMotion& m) {
  const ShellMatrix k = shell_stiffness(s, setting.material);
  const ShellMatrix slope = shell_stiffness_d_thickness(s, setting.material);
  const ShellVector f = shell_weight(weight_third_n(setting, s, m.gravity));
  ShellWorkHessian h = ShellWorkHessian::Zero();
  h(0, 0) = m.lambda.dot(shell_stiffness_d2_thickness(s, setting.material) * m.d);
  h.block<18, 1>(kShellMotion, 0) = slope * m.lambda;
  h.block<18, 1>(kShellMultiplier, 0) = slope * m.d - f / s.thickness_mm;
  h.block<1, 36>(0, 1) = h.block<36, 1>(1, 0).transpose();
  h.block<18, 18>(kShellMotion, kShellMultiplier) = k.transpose();
  h.block<18, 18>(kShellMultiplier, kShellMotion) = k;
  return h;
}

Eigen::Matrix<double, 9, 1> shell_work_d_position(const ElementSetting& setting, const ShellTriangle& s,
                                                  const ShellMotion& m) {
  const auto slopes = shell_stiffness_d_position(s, setting.material);
  const Vector3d twice = (s.corner_mm[1] - s.corner_mm[0]).cross(s.corner_mm[2] - s.corner_mm[0]);
  const double third_a_mm2 = weight_third_n(setting, s, m.gravity) / shell_area_mm2(s);
  const double lifted = m.lambda[2] + m.lambda[8] + m.lambda[14];
  Eigen::Matrix<double, 9, 1> g;
  for (int i = 0; i < 9; ++i) g[i] = m.lambda.dot(slopes[i] * m.d);
  for (int i = 0; i < 3; ++i) {  // the area grows across the side that faces the corner
    const Vector3d side = s.corner_mm[(i + 2) % 3] - s.corner_mm[(i + 1) % 3];
    g.segment<3>(3 * i) += lifted * third_a_mm2 * 0.5 * twice.normalized().cross(side);
  }
  return g;
}

DesignGradient work_gradient(const Structure& s, const Eigen::VectorXd& d, const Eigen::VectorXd& lambda,
                             double gravity) {
  const ElementSetting setting{s.material, s.weight_density_n_mm3};
  const auto nodes = static_cast<Eigen::Index>(s.nodes_mm.size());
  DesignGradient out{Eigen::VectorXd(static_cast<Eigen::Index>(s.struts.size())),
                     Eigen::VectorXd(static_cast<Eigen::Index>(s.struts.size())),
                     Eigen::VectorXd(static_cast<Eigen::Index>(s.shells.size())),
                     Eigen::Matrix3Xd::Zero(3, nodes)};
  for (std::size_t j = 0; j < s.struts.size(); ++j) {
    const StrutMotion m{freedoms_of(s.struts[j], d), freedoms_of(s.struts[j], lambda), gravity};
    const StrutWorkGradient g = rigid_strut_work_gradient(setting, s.strut(j), m);
    out.radius[static_cast<Eigen::Index>(j)] = g[kStrutRadius];
    out.arm[static_cast<Eigen::Index>(j)] = g[kStrutArm];
    for (int i = 0; i < 2; ++i) out.position_mm.col(s.struts[j].nodes[i]) += g.segment<3>(3 * i);
  }
  for (std::size_t i = 0; i < s.shells.size(); ++i) {
    const ShellMotion m{freedoms_of(s.shells[i], d), freedoms_of(s.shells[i], lambda), gravity};
    out.thickness[static_cast<Eigen::Index>(i)] = shell_work_gradient(setting, s.shell(i), m)[0];
    const auto g = shell_work_d_position(setting, s.shell(i), m);
    for (int k = 0; k < 3; ++k) out.position_mm.col(s.shells[i].nodes[k]) += g.segment<3>(3 * k);
  }
  return out;
}

}  // namespace skinframe
