// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/mechanics/strut_strain.h"

namespace skinframe {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

double axial(const Vector3d& e, const Vector3d& delta) {
  const double along = e.dot(delta) / e.squaredNorm();
  return along * along;
}

StrainGradient axial_gradient(const Vector3d& e, const Vector3d& delta) {
  const double l2 = e.squaredNorm(), u = e.dot(delta);
  StrainGradient g;
  g << 2 * u / (l2 * l2) * (delta - 2 * u / l2 * e), 2 * u / (l2 * l2) * e;
  return g;
}

StrainHessian axial_hessian(const Vector3d& e, const Vector3d& delta) {
  const double l2 = e.squaredNorm(), l4 = l2 * l2, l6 = l4 * l2, u = e.dot(delta);
  const Matrix3d identity = Matrix3d::Identity(), ee = e * e.transpose();
  StrainHessian h;
  h.block<3, 3>(0, 0) = 2 / l4 * delta * delta.transpose() -
                        8 * u / l6 * (delta * e.transpose() + e * delta.transpose()) -
                        4 * u * u / l6 * identity + 24 * u * u / (l6 * l2) * ee;
  h.block<3, 3>(0, 3) = 2 / l4 * (delta * e.transpose() + u * identity) - 8 * u / l6 * ee;
  h.block<3, 3>(3, 0) = h.block<3, 3>(0, 3).transpose();
  h.block<3, 3>(3, 3) = 2 / l4 * ee;
  return h;
}

double total(const Vector3d& e, const Vector3d& delta) { return delta.squaredNorm() / e.squaredNorm(); }

StrainGradient total_gradient(const Vector3d& e, const Vector3d& delta) {
  const double l2 = e.squaredNorm();
  StrainGradient g;
  g << -2 * delta.squaredNorm() / (l2 * l2) * e, 2 / l2 * delta;
  return g;
}

StrainHessian total_hessian(const Vector3d& e, const Vector3d& delta) {
  const double l2 = e.squaredNorm(), l4 = l2 * l2, d2 = delta.squaredNorm();
  const Matrix3d identity = Matrix3d::Identity();
  StrainHessian h;
  h.block<3, 3>(0, 0) = -2 * d2 / l4 * identity + 8 * d2 / (l4 * l2) * e * e.transpose();
  h.block<3, 3>(0, 3) = -4 / l4 * e * delta.transpose();
  h.block<3, 3>(3, 0) = h.block<3, 3>(0, 3).transpose();
  h.block<3, 3>(3, 3) = 2 / l2 * identity;
  return h;
}

}  // namespace

double squared_strain(StrainKind kind, const Vector3d& e, const Vector3d& delta) {
  return kind == StrainKind::kAxial ? axial(e, delta) : total(e, delta) - axial(e, delta);
}

StrainGradient squared_strain_gradient(StrainKind kind, const Vector3d& e, const Vector3d& delta) {
  if (kind == StrainKind::kAxial) return axial_gradient(e, delta);
  return total_gradient(e, delta) - axial_gradient(e, delta);
}

StrainHessian squared_strain_hessian(StrainKind kind, const Vector3d& e, const Vector3d& delta) {
  if (kind == StrainKind::kAxial) return axial_hessian(e, delta);
  return total_hessian(e, delta) - axial_hessian(e, delta);
}

}  // namespace skinframe
