// SPDX-License-Identifier: GPL-3.0-or-later
// Hooke's law of the isotropic solid.
#pragma once

#include "worker/stress/elasticity.h"

namespace skinframe {

// Stress (xx yy zz xy yz zx) from engineering strain.
inline Eigen::Matrix<double, 6, 6> isotropic_stiffness(const ElasticMaterial& material) {
  const double e = material.modulus_mpa, nu = material.poisson_ratio;
  const double mu = e / (2.0 * (1.0 + nu));
  Eigen::Matrix<double, 6, 6> d = Eigen::Matrix<double, 6, 6>::Zero();
  d.topLeftCorner<3, 3>().setConstant(e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)));
  for (int i = 0; i < 3; ++i) {
    d(i, i) += 2.0 * mu;
    d(i + 3, i + 3) = mu;  // against engineering shear strain
  }
  return d;
}

}  // namespace skinframe
