// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/structure/rigid_strut.h"

#include <algorithm>
#include <cmath>

#include "worker/structure/strut_formula.h"

namespace skinframe {
namespace {

using Eigen::Vector3d;

using namespace strut_formula;

template <class T>
Matrix12<T> stiffness(const RigidStrut& s, const ElasticMaterial& material, const Variables<T>& x) {
  const Axis<T> axis = axis_of(s, x);
  const auto section = section_of(s.shape, x.radius_mm, material.poisson_ratio);
  const Matrix12<T> to_axis = carry(axis);
  const Matrix12<T> half = straight_stiffness(section, axis.length, material) * to_axis;
  return to_axis.transpose() * half;
}

template <class T, class Part>
StrutMatrix part_of(const Matrix12<T>& k, Part part) {
  StrutMatrix out;
  for (int j = 0; j < 12; ++j)
    for (int i = 0; i < 12; ++i) out(i, j) = part(k(i, j));
  return out;
}

Matrix12<Curve> along_radius(const RigidStrut& s, const ElasticMaterial& material) {
  Variables<Curve> x = constants_of<Curve>(s);
  x.radius_mm = curve_variable(s.radius_mm);
  return stiffness(s, material, x);
}

}  // namespace

StrutMatrix rigid_strut_stiffness(const RigidStrut& s, const ElasticMaterial& material) {
  return stiffness(s, material, values_of(s));
}

StrutMatrix rigid_strut_stiffness_d_radius(const RigidStrut& s, const ElasticMaterial& material) {
  return part_of(along_radius(s, material), [](const Curve& c) { return c.d[0].v; });
}

StrutMatrix rigid_strut_stiffness_d2_radius(const RigidStrut& s, const ElasticMaterial& material) {
  return part_of(along_radius(s, material), [](const Curve& c) { return c.d[0].d[0]; });
}

StrutMatrix rigid_strut_stiffness_d_arm(const RigidStrut& s, const ElasticMaterial& material) {
  Variables<Gradient<1>> x = constants_of<Gradient<1>>(s);
  x.arm_mm = variable<1>(s.arm_mm, 0);
  return part_of(stiffness(s, material, x), [](const Gradient<1>& g) { return g.d[0]; });
}

std::array<StrutMatrix, 6> rigid_strut_stiffness_d_position(const RigidStrut& s,
                                                            const ElasticMaterial& material) {
  Variables<Gradient<6>> x = constants_of<Gradient<6>>(s);
  for (int i = 0; i < 6; ++i) x.node[i / 3][i % 3] = variable<6>(s.node_mm[i / 3][i % 3], i);
  const auto k = stiffness(s, material, x);
  std::array<StrutMatrix, 6> out;
  for (int i = 0; i < 6; ++i) out[i] = part_of(k, [i](const Gradient<6>& g) { return g.d[i]; });
  return out;
}

double rigid_strut_length_mm(const RigidStrut& s) { return axis_of(s, values_of(s)).length; }

StrutVector rigid_strut_weight(const RigidStrut& s, const ElasticMaterial& material,
                               double weight_density_n_mm3) {
  const auto section = section_of(s.shape, s.radius_mm, material.poisson_ratio);
  return weight(axis_of(s, values_of(s)), section.area, weight_density_n_mm3);
}

StrutStress rigid_strut_stress(const RigidStrut& s, const ElasticMaterial& material,
                               const StrutVector& displacement) {
  const Axis<double> axis = axis_of(s, values_of(s));
  const auto section = section_of(s.shape, s.radius_mm, material.poisson_ratio);
  const StrutVector f = straight_stiffness(section, axis.length, material) * (carry(axis) * displacement);
  const double r = s.radius_mm;
  StrutStress out{f[6], 0};
  for (const int end : {0, 6}) {
    const double twist = std::abs(f[end + 3]), in = std::abs(f[end + 4]), bend = std::abs(f[end + 5]);
    const double bending = s.shape == StrutShape::kFullDisc
                               ? std::hypot(in, bend) * r / section.i_in
                               : bend * (1 - kHalfDiscCentroid) * r / section.i_out + in * r / section.i_in;
    const double normal = std::abs(f[end]) / section.area + bending;
    const double shear =
        twist * r / section.torsion + 4.0 / 3.0 * std::hypot(f[end + 1], f[end + 2]) / section.area;
    out.von_mises_mpa = std::max(out.von_mises_mpa, std::sqrt(normal * normal + 3 * shear * shear));
  }
  return out;
}

StrutMatrix rigid_strut_geometric_stiffness(const RigidStrut& s, double axial_force_n) {
  const Axis<double> axis = axis_of(s, values_of(s));
  const double l = axis.length, p = axial_force_n / l;
  StrutMatrix k = StrutMatrix::Zero();
  for (const auto& [v, r, sign] : {std::tuple{1, 5, 1.0}, std::tuple{2, 4, -1.0}}) {
    add_pair(k, v, v, 1.2 * p);
    add_pair(k, v + 6, v + 6, 1.2 * p);
    add_pair(k, v, v + 6, -1.2 * p);
    for (const int rotation : {r, r + 6}) {
      add_pair(k, v, rotation, sign * p * l / 10);
      add_pair(k, v + 6, rotation, -sign * p * l / 10);
      add_pair(k, rotation, rotation, 2 * p * l * l / 15);
    }
    add_pair(k, r, r + 6, -p * l * l / 30);
  }
  const StrutMatrix to_axis = carry(axis);
  return to_axis.transpose() * k * to_axis;
}

}  // namespace skinframe
