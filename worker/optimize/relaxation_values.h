// SPDX-License-Identifier: GPL-3.0-or-later
// What a convex relaxation (convex_relaxation.h) is worth at one point: forces, energies, the terms' excess,
// the gradient in A. Depends on the point alone, not on the barrier or its duals. Nondimensional.
#pragma once

#include <vector>

#include "worker/optimize/convex_relaxation.h"

namespace skinframe {

struct RelaxationValues {
  Eigen::VectorXd weights;              // u_k: one a load case
  Eigen::VectorXd displacements;        // y = w / u, a full vector like the two below
  Eigen::VectorXd forces, internal;     // F(A), and K(A) y; zero on fixed axes
  Eigen::VectorXd stored;               // y^T K y: one a load case
  Eigen::VectorXd excess;               // of the terms; <= 0 is kept
  Eigen::VectorXd gradient;             // of the saddle function in A
  std::vector<Eigen::Matrix3Xd> pulls;  // B delta of each strut, one a load case
  Eigen::MatrixXd energies;             // delta^T B delta: struts x load cases
  // How far from equilibrium: of the largest force there is.
  double worst_force() const;
};

// u_k, the sum of the multipliers of load case k's terms.
double case_weight(const Relaxation& relaxation, const SaddlePoint& point, int load_case);

// Multiplies the part of `full` that is load case k's by factors[k].
void scale_cases(const Relaxation& relaxation, const Eigen::VectorXd& factors, Eigen::VectorXd* full);

RelaxationValues relaxation_values(const Relaxation& relaxation, const SaddlePoint& point);

}  // namespace skinframe
