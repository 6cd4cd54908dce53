// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/structure/rigid_strut.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "worker/structure/jet.h"

namespace skinframe {
namespace {

using Eigen::Vector3d;

template <class T>
using Vector3 = Eigen::Matrix<T, 3, 1>;
template <class T>
using Matrix3 = Eigen::Matrix<T, 3, 3>;
template <class T>
using Matrix12 = Eigen::Matrix<T, 12, 12>;

// What the derivatives are taken in.
template <class T>
struct Variables {
  std::array<Vector3<T>, 2> node;
  T arm_mm, radius_mm;
};

Variables<double> values_of(const RigidStrut& s) { return {s.node_mm, s.arm_mm, s.radius_mm}; }

template <class T>
Variables<T> constants_of(const RigidStrut& s) {
  return {{s.node_mm[0].cast<T>(), s.node_mm[1].cast<T>()}, T(s.arm_mm), T(s.radius_mm)};
}

template <class T>
struct Axis {
  std::array<Vector3<T>, 2> arm;  // from node to axis
  Matrix3<T> turn;                // rows: along, outward (in the plane of the skin's normal), across
  T length;
};

// A direction that is not along the axis: the skin's normal for the half disc, any for the full one, whose
// stiffness does not depend on it.
Vector3d side_of(const RigidStrut& s, const Vector3d& along) {
  if (s.shape == StrutShape::kHalfDisc)
    for (const Vector3d& side : {Vector3d(s.arm[0] + s.arm[1]), s.arm[0], s.arm[1]})
      if (side.cross(along).norm() > 0.05) return side;
  int least = 0;
  along.cwiseAbs().minCoeff(&least);
  return Vector3d::Unit(least);
}

template <class T>
Axis<T> axis_of(const RigidStrut& s, const Variables<T>& x) {
  using std::sqrt;
  Axis<T> axis;
  T reach = x.arm_mm;
  if (s.shape == StrutShape::kHalfDisc) reach += T(kHalfDiscCentroid) * x.radius_mm;
  for (int i = 0; i < 2; ++i) axis.arm[i] = s.arm[i].template cast<T>() * reach;
  Vector3<T> e = x.node[1] + axis.arm[1] - x.node[0] - axis.arm[0];
  axis.length = sqrt(e.dot(e));
  e = Vector3<T>(e * (T(1.0) / axis.length));
  const Vector3d along(value_of(e[0]), value_of(e[1]), value_of(e[2]));
  const Vector3<T> side = side_of(s, along).template cast<T>();
  Vector3<T> out = side - e * side.dot(e);
  out = Vector3<T>(out * (T(1.0) / sqrt(out.dot(out))));
  const Vector3<T> across(e[1] * out[2] - e[2] * out[1], e[2] * out[0] - e[0] * out[2],
                          e[0] * out[1] - e[1] * out[0]);
  axis.turn.row(0) = e.transpose();
  axis.turn.row(1) = out.transpose();
  axis.turn.row(2) = across.transpose();
  return axis;
}

// R O: from the nodes' motion to that of the axis' ends, in the strut's axes.
template <class T>
Matrix12<T> carry(const Axis<T>& axis) {
  Matrix12<T> out = Matrix12<T>::Constant(T(0.0));
  for (int i = 0; i < 2; ++i) {
    const Vector3<T>& a = axis.arm[i];
    Matrix3<T> swing;  // theta x arm
    swing << T(0.0), a[2], -a[1], -a[2], T(0.0), a[0], a[1], -a[0], T(0.0);
    out.template block<3, 3>(6 * i, 6 * i) = axis.turn;
    out.template block<3, 3>(6 * i, 6 * i + 3) = axis.turn * swing;
    out.template block<3, 3>(6 * i + 3, 6 * i + 3) = axis.turn;
  }
  return out;
}

template <class T>
void add_pair(Matrix12<T>& k, int i, int j, const T& value) {
  k(i, j) = value;
  k(j, i) = value;
}

// Bending in one plane: deflections v, v + 6, rotations r, r + 6; sign of a rotation that lifts the far end.
template <class T>
void add_bending(Matrix12<T>& k, int v, int r, double sign, const T& bending, const T& shear, const T& l) {
  const T phi = T(12.0) * bending / (shear * l * l);
  const T base = bending / (l * l * l * (T(1.0) + phi));
  const T push = T(12.0) * base, lever = T(6.0 * sign) * base * l;
  add_pair(k, v, v, push);
  add_pair(k, v + 6, v + 6, push);
  add_pair(k, v, v + 6, T(-push));
  for (const int rotation : {r, r + 6}) {
    add_pair(k, v, rotation, lever);
    add_pair(k, v + 6, rotation, T(-lever));
    add_pair(k, rotation, rotation, T((T(4.0) + phi) * base * l * l));
  }
  add_pair(k, r, r + 6, T((T(2.0) - phi) * base * l * l));
}

template <class T>
Matrix12<T> straight_stiffness(const StrutSection<T>& section, const T& l, const ElasticMaterial& material) {
  const T e(material.modulus_mpa), g(material.modulus_mpa / (2 * (1 + material.poisson_ratio)));
  Matrix12<T> k = Matrix12<T>::Constant(T(0.0));
  const auto add_spring = [&](int i, const T& spring) {
    add_pair(k, i, i, spring);
    add_pair(k, i + 6, i + 6, spring);
    add_pair(k, i, i + 6, T(-spring));
  };
  add_spring(0, T(e * section.area / l));
  add_spring(3, T(g * section.torsion / l));
  const T shear = T(section.shear_coefficient) * g * section.area;
  add_bending(k, 1, 5, +1, T(e * section.i_out), shear, l);
  add_bending(k, 2, 4, -1, T(e * section.i_in), shear, l);
  return k;
}

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
  const Axis<double> axis = axis_of(s, values_of(s));
  const double l = axis.length;
  const double area = section_of(s.shape, s.radius_mm, material.poisson_ratio).area;
  const Vector3d q = axis.turn * Vector3d(0, 0, -weight_density_n_mm3 * area);  // a mm of length
  StrutVector f;
  f << q * l / 2, 0, -q[2] * l * l / 12, q[1] * l * l / 12, q * l / 2, 0, q[2] * l * l / 12,
      -q[1] * l * l / 12;
  return carry(axis).transpose() * f;
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
