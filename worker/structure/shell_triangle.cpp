// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/structure/shell_triangle.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "worker/structure/jet.h"
#include "worker/structure/plate.h"

namespace skinframe {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

template <class T>
using Vector3 = Eigen::Matrix<T, 3, 1>;
template <class T>
using Matrix18 = Eigen::Matrix<T, 18, 18>;

constexpr std::array<int, 3> kMembraneFreedoms = {0, 1, 5}, kPlateFreedoms = {2, 3, 4};

template <class T>
struct Placed {
  Eigen::Matrix<T, 3, 3> turn;  // rows: along the first side, across in the plane, normal
  FlatTriangle<T> flat;
};

template <class T>
Placed<T> place(const std::array<Vector3<T>, 3>& corner) {
  using std::sqrt;
  const Vector3<T> a = corner[1] - corner[0], b = corner[2] - corner[0];
  const Vector3<T> n(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
  const T twice = sqrt(n.dot(n)), l = sqrt(a.dot(a));
  const Vector3<T> ex = a * (T(1.0) / l), ez = n * (T(1.0) / twice);
  const Vector3<T> ey(ez[1] * ex[2] - ez[2] * ex[1], ez[2] * ex[0] - ez[0] * ex[2],
                      ez[0] * ex[1] - ez[1] * ex[0]);
  Placed<T> out;
  out.turn.row(0) = ex.transpose();
  out.turn.row(1) = ey.transpose();
  out.turn.row(2) = ez.transpose();
  out.flat.x = Vector3<T>(T(0.0), l, b.dot(ex));
  out.flat.y = Vector3<T>(T(0.0), T(0.0), b.dot(ey));
  out.flat.area = twice * T(0.5);
  return out;
}

// membrane * K_m + plate * K_b, in global axes.
template <class T>
Matrix18<T> stiffness(const std::array<Vector3<T>, 3>& corner, double membrane, double plate,
                      const ElasticMaterial& material) {
  const Placed<T> placed = place(corner);
  const auto km = membrane_stiffness(placed.flat, material.modulus_mpa, material.poisson_ratio);
  const auto kb = plate_stiffness(placed.flat, material.modulus_mpa, material.poisson_ratio);
  Matrix18<T> local = Matrix18<T>::Constant(T(0.0));
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j < 9; ++j) {
      local(6 * (i / 3) + kMembraneFreedoms[i % 3], 6 * (j / 3) + kMembraneFreedoms[j % 3]) =
          T(membrane) * km(i, j);
      local(6 * (i / 3) + kPlateFreedoms[i % 3], 6 * (j / 3) + kPlateFreedoms[j % 3]) = T(plate) * kb(i, j);
    }
  Matrix18<T> out;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      const Eigen::Matrix<T, 3, 3> half = local.template block<3, 3>(3 * i, 3 * j) * placed.turn;
      out.template block<3, 3>(3 * i, 3 * j) = placed.turn.transpose() * half;
    }
  return out;
}

double cubed(double t) { return t * t * t; }

}  // namespace

ShellMatrix shell_stiffness(const ShellTriangle& s, const ElasticMaterial& material) {
  return stiffness<double>(s.corner_mm, s.thickness_mm, cubed(s.thickness_mm) / 12, material);
}

ShellMatrix shell_stiffness_d_thickness(const ShellTriangle& s, const ElasticMaterial& material) {
  return stiffness<double>(s.corner_mm, 1, s.thickness_mm * s.thickness_mm / 4, material);
}

ShellMatrix shell_stiffness_d2_thickness(const ShellTriangle& s, const ElasticMaterial& material) {
  return stiffness<double>(s.corner_mm, 0, s.thickness_mm / 2, material);
}

std::array<ShellMatrix, 9> shell_stiffness_d_position(const ShellTriangle& s,
                                                      const ElasticMaterial& material) {
  using G = Gradient<9>;
  std::array<Vector3<G>, 3> corner;
  for (int i = 0; i < 9; ++i) corner[i / 3][i % 3] = variable<9>(s.corner_mm[i / 3][i % 3], i);
  const Matrix18<G> k = stiffness<G>(corner, s.thickness_mm, cubed(s.thickness_mm) / 12, material);
  std::array<ShellMatrix, 9> out;
  for (int m = 0; m < 9; ++m)
    for (int j = 0; j < 18; ++j)
      for (int i = 0; i < 18; ++i) out[m](i, j) = k(i, j).d[m];
  return out;
}

double shell_area_mm2(const ShellTriangle& s) {
  return 0.5 * (s.corner_mm[1] - s.corner_mm[0]).cross(s.corner_mm[2] - s.corner_mm[0]).norm();
}

ShellStress shell_stress(const ShellTriangle& s, const ElasticMaterial& material, const ShellVector& d) {
  const Placed<double> placed = place<double>(s.corner_mm);
  Eigen::Matrix<double, 9, 1> in_plane, bending;
  for (int i = 0; i < 3; ++i) {
    const Vector3d u = placed.turn * d.segment<3>(6 * i), theta = placed.turn * d.segment<3>(6 * i + 3);
    in_plane.segment<3>(3 * i) << u[0], u[1], theta[2];
    bending.segment<3>(3 * i) << u[2], theta[0], theta[1];
  }
  const Matrix3d c = plane_stress(material.modulus_mpa, material.poisson_ratio);
  ShellStress out;
  out.membrane_mpa = c * Vector3d(membrane_lumping(placed.flat).transpose() * in_plane) / placed.flat.area;
  const double third = 1.0 / 3.0;
  out.bending_mpa =
      0.5 * s.thickness_mm * c * Vector3d(plate_curvature(placed.flat, {third, third, third}) * bending);
  for (const double side : {-1.0, 1.0}) {
    const Vector3d z = out.membrane_mpa + side * out.bending_mpa;
    out.von_mises_mpa =
        std::max(out.von_mises_mpa, std::sqrt(z[0] * z[0] - z[0] * z[1] + z[1] * z[1] + 3 * z[2] * z[2]));
  }
  return out;
}

ShellMatrix shell_geometric_stiffness(const ShellTriangle& s, const Vector3d& membrane_mpa) {
  const Placed<double> placed = place<double>(s.corner_mm);
  const FlatTriangle<double>& t = placed.flat;
  Eigen::Matrix2d force;  // a mm of width
  force << membrane_mpa[0], membrane_mpa[2], membrane_mpa[2], membrane_mpa[1];
  force *= s.thickness_mm;
  Eigen::Matrix<double, 2, 3> slope;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    slope.col(i) << (t.y[j] - t.y[k]) / (2 * t.area), (t.x[k] - t.x[j]) / (2 * t.area);
  }
  const Matrix3d k = t.area * slope.transpose() * force * slope;
  ShellMatrix out = ShellMatrix::Zero();  // the same for every direction of displacement
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) out.block<3, 3>(6 * i, 6 * j) = k(i, j) * Matrix3d::Identity();
  return out;
}

}  // namespace skinframe
