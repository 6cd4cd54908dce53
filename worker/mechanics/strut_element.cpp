// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/mechanics/strut_element.h"

namespace skinframe {

using Eigen::Matrix3d;
using Eigen::Vector3d;

StrutSprings strut_springs(ElementModel model, const Material& material) {
  const double shear = model == ElementModel::kPaper ? material.shear_modulus_mpa : 0.0;
  return {material.tensile_modulus_mpa, shear, material.weight_density_n_mm3() / 2};
}

Matrix3d strut_stiffness(const StrutSprings& springs, const Vector3d& e) {
  const double l = e.norm();
  return springs.shear / l * Matrix3d::Identity() +
         (springs.axial - springs.shear) / (l * l * l) * e * e.transpose();
}

double strut_work(const StrutSprings& springs, const StrutState& q) {
  const double l = q.e.norm();
  return springs.shear / l * q.delta.dot(q.eta) +
         (springs.axial - springs.shear) / (l * l * l) * q.e.dot(q.delta) * q.e.dot(q.eta) +
         springs.half_weight * l * q.s;
}

StrutGradient strut_work_gradient(const StrutSprings& springs, const StrutState& q) {
  const double l = q.e.norm();
  const double m1 = springs.shear / l, m3 = m1 / (l * l);
  const double k3 = (springs.axial - springs.shear) / (l * l * l), k5 = k3 / (l * l);
  const double along = q.e.dot(q.delta), pull = q.e.dot(q.eta);

  StrutGradient g;
  g.segment<3>(0) = (springs.half_weight * q.s / l - m3 * q.delta.dot(q.eta) - 3 * k5 * along * pull) * q.e +
                    k3 * (pull * q.delta + along * q.eta);
  g.segment<3>(3) = m1 * q.eta + k3 * pull * q.e;
  g.segment<3>(6) = m1 * q.delta + k3 * along * q.e;
  g[9] = springs.half_weight * l;
  return g;
}

StrutHessian strut_work_hessian(const StrutSprings& springs, const StrutState& q) {
  const double l = q.e.norm(), l2 = l * l;
  const double m1 = springs.shear / l, m3 = m1 / l2, m5 = m3 / l2;
  const double k3 = (springs.axial - springs.shear) / (l2 * l), k5 = k3 / l2, k7 = k5 / l2;
  const double along = q.e.dot(q.delta), pull = q.e.dot(q.eta), product = q.delta.dot(q.eta);
  const Matrix3d identity = Matrix3d::Identity();
  const Matrix3d ee = q.e * q.e.transpose();
  const Vector3d v = pull * q.delta + along * q.eta;

  StrutHessian h = StrutHessian::Zero();
  h.block<3, 3>(0, 0) = -product * (m3 * identity - 3 * m5 * ee) -
                        3 * along * pull * (k5 * identity - 5 * k7 * ee) -
                        3 * k5 * (q.e * v.transpose() + v * q.e.transpose()) +
                        k3 * (q.delta * q.eta.transpose() + q.eta * q.delta.transpose()) +
                        springs.half_weight * q.s * (identity / l - ee / (l2 * l));
  h.block<3, 3>(0, 3) =
      -m3 * q.e * q.eta.transpose() - 3 * k5 * pull * ee + k3 * (pull * identity + q.eta * q.e.transpose());
  h.block<3, 3>(0, 6) = -m3 * q.e * q.delta.transpose() - 3 * k5 * along * ee +
                        k3 * (along * identity + q.delta * q.e.transpose());
  h.block<3, 1>(0, 9) = springs.half_weight / l * q.e;
  h.block<3, 3>(3, 6) = m1 * identity + k3 * ee;
  h.block<3, 3>(3, 0) = h.block<3, 3>(0, 3).transpose();
  h.block<3, 3>(6, 0) = h.block<3, 3>(0, 6).transpose();
  h.block<1, 3>(9, 0) = h.block<3, 1>(0, 9).transpose();
  h.block<3, 3>(6, 3) = h.block<3, 3>(3, 6);
  return h;
}

}  // namespace skinframe
