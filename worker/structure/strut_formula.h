// SPDX-License-Identifier: GPL-3.0-or-later
// The straight beam of rigid_strut.h as formulas over any number that jet.h knows, so that what is written
// once gives values and exact derivatives. For the .cpp files of this room.
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "worker/structure/jet.h"
#include "worker/structure/rigid_strut.h"

namespace skinframe::strut_formula {

template <class T>
using Vector3 = Eigen::Matrix<T, 3, 1>;
template <class T>
using Matrix3 = Eigen::Matrix<T, 3, 3>;
template <class T>
using Matrix12 = Eigen::Matrix<T, 12, 12>;
template <class T>
using Vector12 = Eigen::Matrix<T, 12, 1>;

// What the derivatives are taken in.
template <class T>
struct Variables {
  std::array<Vector3<T>, 2> node;
  T arm_mm, radius_mm;
};

inline Variables<double> values_of(const RigidStrut& s) { return {s.node_mm, s.arm_mm, s.radius_mm}; }

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
inline Eigen::Vector3d side_of(const RigidStrut& s, const Eigen::Vector3d& along) {
  if (s.shape == StrutShape::kHalfDisc)
    for (const Eigen::Vector3d& side : {Eigen::Vector3d(s.arm[0] + s.arm[1]), s.arm[0], s.arm[1]})
      if (side.cross(along).norm() > 0.05) return side;
  int least = 0;
  along.cwiseAbs().minCoeff(&least);
  return Eigen::Vector3d::Unit(least);
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
  const Eigen::Vector3d along(value_of(e[0]), value_of(e[1]), value_of(e[2]));
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

// Consistent nodal forces and moments of the weight along -z.
template <class T>
Vector12<T> weight(const Axis<T>& axis, const T& area, double weight_density_n_mm3) {
  const T& l = axis.length;
  const Vector3<T> q = axis.turn.col(2) * (T(-weight_density_n_mm3) * area);  // a mm of length
  Vector12<T> f;
  f << q[0] * l * T(0.5), q[1] * l * T(0.5), q[2] * l * T(0.5), T(0.0), -q[2] * l * l * T(1.0 / 12),
      q[1] * l * l * T(1.0 / 12), q[0] * l * T(0.5), q[1] * l * T(0.5), q[2] * l * T(0.5), T(0.0),
      q[2] * l * l * T(1.0 / 12), -q[1] * l * l * T(1.0 / 12);
  return carry(axis).transpose() * f;
}

}  // namespace skinframe::strut_formula
