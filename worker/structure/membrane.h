// SPDX-License-Identifier: GPL-3.0-or-later
// The in-plane stiffness of a flat triangle with drilling rotations, Felippa's OPT (C. A. Felippa, "A study
// of optimal membrane triangles with drilling freedoms", Comput. Methods Appl. Mech. Engrg. 192, 2003):
// alpha_b = 3/2, beta_0 = (1 - 4 nu^2) / 2, at least 0.01. It bends in its plane without locking.
//
// Freedoms: u v theta of each corner, theta = (v_x - u_y) / 2. All per unit of thickness.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>

namespace skinframe {

template <class T>
struct FlatTriangle {
  Eigen::Matrix<T, 3, 1> x, y;  // of the corners, counter-clockwise, mm
  T area;
};

// E / (1 - nu^2) [1 nu 0; nu 1 0; 0 0 (1 - nu) / 2]
inline Eigen::Matrix3d plane_stress(double modulus_mpa, double poisson_ratio) {
  Eigen::Matrix3d c;
  c << 1, poisson_ratio, 0, poisson_ratio, 1, 0, 0, 0, (1 - poisson_ratio) / 2;
  return c * (modulus_mpa / (1 - poisson_ratio * poisson_ratio));
}

// L of the basic stiffness L C L^T / A; the mean strain is L^T d / A.
template <class T>
Eigen::Matrix<T, 9, 3> membrane_lumping(const FlatTriangle<T>& t) {
  constexpr double kAlpha = 1.5;
  Eigen::Matrix<T, 9, 3> l = Eigen::Matrix<T, 9, 3>::Constant(T(0.0));
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const T b = t.y[j] - t.y[k], c = t.x[k] - t.x[j];    // of the side across
    const T yj = t.y[i] - t.y[j], yk = t.y[i] - t.y[k];  // y_ij, y_ik
    const T xj = t.x[i] - t.x[j], xk = t.x[i] - t.x[k];  // x_ij, x_ik
    l(3 * i, 0) = T(0.5) * b;
    l(3 * i, 2) = T(0.5) * c;
    l(3 * i + 1, 1) = T(0.5) * c;
    l(3 * i + 1, 2) = T(0.5) * b;
    l(3 * i + 2, 0) = T(kAlpha / 12) * b * (yk + yj);
    l(3 * i + 2, 1) = T(kAlpha / 12) * c * (-xj - xk);
    l(3 * i + 2, 2) = T(kAlpha / 6) * (xj * yj - xk * yk);
  }
  return l;
}

// Higher order part: strains along the sides from the corners' rotations beyond the mean one.
template <class T>
Eigen::Matrix<T, 9, 9> membrane_stiffness(const FlatTriangle<T>& t, double modulus_mpa,
                                          double poisson_ratio) {
  using Matrix3 = Eigen::Matrix<T, 3, 3>;
  const Matrix3 c = plane_stress(modulus_mpa, poisson_ratio).template cast<T>();
  const double beta0 = std::max(0.01, 0.5 * (1 - 4 * poisson_ratio * poisson_ratio));
  const auto x = [&](int i, int j) { return T(t.x[i - 1] - t.x[j - 1]); };
  const auto y = [&](int i, int j) { return T(t.y[i - 1] - t.y[j - 1]); };
  const auto squared = [&](int i, int j) { return T(x(i, j) * x(i, j) + y(i, j) * y(i, j)); };
  const T l21 = squared(2, 1), l32 = squared(3, 2), l13 = squared(1, 3);

  const T quarter = T(0.25) / t.area;
  Eigen::Matrix<T, 3, 9> rotation = Eigen::Matrix<T, 3, 9>::Constant(T(0.0));
  for (int i = 0; i < 3; ++i) {
    rotation(i, 3 * i + 2) = T(1.0);
    for (int k = 0; k < 3; ++k) {
      const int from = (k + 1) % 3 + 1, to = (k + 2) % 3 + 1;
      rotation(i, 3 * k) = x(to, from) * quarter;
      rotation(i, 3 * k + 1) = y(to, from) * quarter;
    }
  }
  // From strains along the sides 21, 32, 13 to Cartesian ones.
  Matrix3 along;
  along << y(2, 3) * y(1, 3) * l21, y(3, 1) * y(2, 1) * l32, y(1, 2) * y(3, 2) * l13,  //
      x(2, 3) * x(1, 3) * l21, x(3, 1) * x(2, 1) * l32, x(1, 2) * x(3, 2) * l13,       //
      (y(2, 3) * x(3, 1) + x(3, 2) * y(1, 3)) * l21, (y(3, 1) * x(1, 2) + x(1, 3) * y(2, 1)) * l32,
      (y(1, 2) * x(2, 3) + x(2, 1) * y(3, 2)) * l13;
  along = Matrix3(along * (T(0.25) / (t.area * t.area)));
  const Matrix3 natural = along.transpose() * Matrix3(c * along);

  // The optimal betas 1..9: 1 2 1 0 1 -1 -1 -1 -2, turned from corner to corner.
  const double beta[3][9] = {
      {1, 2, 1, 0, 1, -1, -1, -1, -2}, {-2, -1, -1, 1, 1, 2, -1, 0, 1}, {1, -1, 0, -1, -2, -1, 2, 1, 1}};
  const T sides[3] = {l21, l32, l13};
  Matrix3 q[3];
  for (int corner = 0; corner < 3; ++corner)
    for (int side = 0; side < 3; ++side)
      for (int j = 0; j < 3; ++j)
        q[corner](side, j) = T(2.0 / 3.0 * beta[corner][3 * side + j]) * t.area / sides[side];
  Matrix3 higher = Matrix3::Constant(T(0.0));
  for (int k = 0; k < 3; ++k) {  // at the middles of the sides
    const Matrix3 mean = (q[k] + q[(k + 1) % 3]) * T(0.5);
    higher += Matrix3(mean.transpose() * Matrix3(natural * mean));
  }
  const Eigen::Matrix<T, 9, 3> l = membrane_lumping(t);
  const Eigen::Matrix<T, 3, 9> basic = c * l.transpose();
  const Eigen::Matrix<T, 3, 9> scaled = higher * rotation;
  const Eigen::Matrix<T, 9, 9> first = l * basic, second = rotation.transpose() * scaled;
  return first * (T(1.0) / t.area) + second * (T(0.75 * beta0) * t.area);
}

}  // namespace skinframe
