// SPDX-License-Identifier: GPL-3.0-or-later
// The strut a -> b as the optimiser sees it: its part of the equilibrium Lagrangian, lambda^T (K D - F) = sum
// A_j P_j + ...
//
//   P(e, delta, eta, s) = delta^T B(e) eta + w l s,     B(e) = (mu / l) I + ((gamma - mu) / l^3) e e^T
//
//   e = x_b - x_a, l = |e|, delta = d_b - d_a, eta = lambda_b - lambda_a, s = lambda_az + lambda_bz, w = rho
//   g / 2.
//
// A B is the strut's stiffness of the paper's eq. (1); w l A is half its weight. gamma, mu: tensile and shear
// modulus. Any consistent units; the optimiser uses nondimensional ones. Guarantee: e is never zero
// (FrameProblem, invariant 1).
//
// A further element joins by its name in ElementModel and its own functions of these shapes.
#pragma once

#include <Eigen/Core>

#include "worker/mechanics/frame_problem.h"

namespace skinframe {

struct StrutSprings {
  double axial = 0;        // gamma
  double shear = 0;        // mu; zero for the axial element
  double half_weight = 0;  // w = rho g / 2, per volume
};
StrutSprings strut_springs(ElementModel model, const Material& material);  // MPa, MPa, N/mm3

struct StrutState {
  Eigen::Vector3d e = Eigen::Vector3d::Zero();
  Eigen::Vector3d delta = Eigen::Vector3d::Zero();
  Eigen::Vector3d eta = Eigen::Vector3d::Zero();
  double s = 0;
};

// Order of derivatives: e (0..2), delta (3..5), eta (6..8), s (9).
using StrutGradient = Eigen::Matrix<double, 10, 1>;
using StrutHessian = Eigen::Matrix<double, 10, 10>;

Eigen::Matrix3d strut_stiffness(const StrutSprings& springs, const Eigen::Vector3d& e);  // B(e)
double strut_work(const StrutSprings& springs, const StrutState& state);                 // P
StrutGradient strut_work_gradient(const StrutSprings& springs, const StrutState& state);
StrutHessian strut_work_hessian(const StrutSprings& springs, const StrutState& state);

}  // namespace skinframe
