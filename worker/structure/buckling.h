// SPDX-License-Identifier: GPL-3.0-or-later
// First linear buckling factor: the least lambda > 0 with
//
//   (K + lambda K_g) phi = 0,   K_g: geometric stiffness of the stress of a solved load case.
//
// Solved as -K_g phi = mu K phi for the largest mu = 1 / lambda by Spectra's Lanczos method, with the halves
// of K's factorisation about K_g: shift and invert about lambda = 0. A strut that has to buckle by itself
// needs an inner node (two parts find the pinned column's load to 1 %).
#pragma once

#include <optional>

#include "worker/structure/solve_structure.h"

namespace skinframe {

inline constexpr double kBucklingTolerance = 1e-4;  // relative, of mu

// displacement: of one load case. None: nothing is compressed so that any multiple of the load would buckle
// it. Error: kInternal when the iteration does not converge.
Result<std::optional<double>> buckling_factor(const StructureSolver& solver,
                                              const Eigen::VectorXd& displacement);

// Euler's load of the bar pinned at both ends, pi^2 E I / l^2, I the smaller one: a joint that gives way is
// assumed at either end, so that this is on the safe side.
double euler_load_n(double modulus_mpa, double least_inertia_mm4, double length_mm);

}  // namespace skinframe
