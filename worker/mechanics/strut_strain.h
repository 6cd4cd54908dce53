// SPDX-License-Identifier: GPL-3.0-or-later
// Squared strains of a strut, the convex form of the stress limits (2) and (3):
//
//   axial:  (e . delta)^2 / l^4                      <= (sigma / gamma)^2
//   shear:  |delta|^2 / l^2 - (e . delta)^2 / l^4    <= (tau / mu)^2
//
// Both are convex quadratics in delta; e enters when the ends move. Derivatives in the order e (0..2), delta
// (3..5).
#pragma once

#include <Eigen/Core>

namespace skinframe {

enum class StrainKind { kAxial, kShear };

using StrainGradient = Eigen::Matrix<double, 6, 1>;
using StrainHessian = Eigen::Matrix<double, 6, 6>;

double squared_strain(StrainKind kind, const Eigen::Vector3d& e, const Eigen::Vector3d& delta);
StrainGradient squared_strain_gradient(StrainKind kind, const Eigen::Vector3d& e,
                                       const Eigen::Vector3d& delta);
StrainHessian squared_strain_hessian(StrainKind kind, const Eigen::Vector3d& e, const Eigen::Vector3d& delta);

}  // namespace skinframe
