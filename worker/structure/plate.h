// SPDX-License-Identifier: GPL-3.0-or-later
// The bending of a thin flat triangle: discrete Kirchhoff (Batoz, Bathe, Ho, "A study of three-node
// triangular plate bending elements", Int. J. Numer. Meth. Engng 15, 1980). Rotations beta = -grad w are
// quadratic; along each side w is cubic, and Kirchhoff's hypothesis holds at corners and middles of the
// sides:
//
//   beta_mid = -3/2 e (w_j - w_i) / l^2 + (I / 2 - 3/4 e e^T / l^2) (beta_i + beta_j),   e = x_j - x_i
//
// Freedoms: w theta_x theta_y of each corner, theta_x = w_y, theta_y = -w_x. To be multiplied by t^3 / 12.
#pragma once

#include "worker/structure/membrane.h"

namespace skinframe {

// Curvatures kappa = (beta_x,x  beta_y,y  beta_x,y + beta_y,x) at area coordinates a. Stress at z is
// z C kappa.
template <class T>
Eigen::Matrix<T, 3, 9> plate_curvature(const FlatTriangle<T>& t, const std::array<double, 3>& a) {
  using Vector2 = Eigen::Matrix<T, 2, 1>;
  using Rotation = Eigen::Matrix<T, 2, 9>;
  Vector2 slope[3];  // of the area coordinates
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    slope[i] = Vector2(t.y[j] - t.y[k], t.x[k] - t.x[j]) * (T(0.5) / t.area);
  }
  Rotation corner[3];
  for (int i = 0; i < 3; ++i) {
    corner[i] = Rotation::Constant(T(0.0));
    corner[i](0, 3 * i + 2) = T(1.0);
    corner[i](1, 3 * i + 1) = T(-1.0);
  }
  Eigen::Matrix<T, 3, 9> kappa = Eigen::Matrix<T, 3, 9>::Constant(T(0.0));
  const auto add = [&](const Rotation& beta, const Vector2& g) {
    for (int d = 0; d < 9; ++d) {
      kappa(0, d) += beta(0, d) * g[0];
      kappa(1, d) += beta(1, d) * g[1];
      kappa(2, d) += beta(0, d) * g[1] + beta(1, d) * g[0];
    }
  };
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    add(corner[i], Vector2(slope[i] * T(4 * a[i] - 1)));
    const Vector2 e(t.x[j] - t.x[i], t.y[j] - t.y[i]);
    const T inverse = T(1.0) / e.dot(e);
    Eigen::Matrix<T, 2, 2> keep = e * e.transpose();
    keep = Eigen::Matrix<T, 2, 2>(keep * (T(-0.75) * inverse));
    keep(0, 0) += T(0.5);
    keep(1, 1) += T(0.5);
    Rotation middle = keep * Rotation(corner[i] + corner[j]);
    for (int k = 0; k < 2; ++k) {
      middle(k, 3 * i) += T(1.5) * e[k] * inverse;
      middle(k, 3 * j) -= T(1.5) * e[k] * inverse;
    }
    add(middle, Vector2((slope[i] * T(a[j]) + slope[j] * T(a[i])) * T(4.0)));
  }
  return kappa;
}

template <class T>
Eigen::Matrix<T, 9, 9> plate_stiffness(const FlatTriangle<T>& t, double modulus_mpa, double poisson_ratio) {
  const Eigen::Matrix<T, 3, 3> c = plane_stress(modulus_mpa, poisson_ratio).template cast<T>();
  Eigen::Matrix<T, 9, 9> k = Eigen::Matrix<T, 9, 9>::Constant(T(0.0));
  const std::array<double, 3> middles[] = {{0.5, 0.5, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}};
  for (const auto& at : middles) {
    const Eigen::Matrix<T, 3, 9> b = plate_curvature(t, at);
    const Eigen::Matrix<T, 3, 9> moment = c * b;
    k += Eigen::Matrix<T, 9, 9>(b.transpose() * moment);
  }
  return k * (t.area * T(1.0 / 3.0));
}

}  // namespace skinframe
