// SPDX-License-Identifier: GPL-3.0-or-later
// The energy of a centroidal Voronoi tessellation of M1 (Yan et al., "Isotropic Remeshing with Fast and Exact
// Computation of Restricted Voronoi Diagram", 2009; Liu et al., "On Centroidal Voronoi Tessellation - Energy
// Smoothness and Fast Computation", 2009), and its minimisation by L-BFGS:
//     E(s) = sum_v w_v min_i |x_v - s_i|^2,   dE/ds_i = 2 sum_(v nearest to i) w_v (s_i - x_v)
// The surface stands as its vertices x_v (some 200 to a site) with weights w_v = area / a^4: the density
// whose tessellation has edges of length a.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "worker/run/run_context.h"

namespace skinframe {

struct WeightedSamples {
  std::vector<Eigen::Vector3d> points;
  std::vector<double> weights;
};

// The energy and, unless gradient is null, its gradient. Same at any thread count. Sites need not be on the
// surface.
double cvt_energy(const WeightedSamples& samples, const std::vector<Eigen::Vector3d>& sites, int threads,
                  std::vector<Eigen::Vector3d>* gradient);

// Moves the sites that are not held to lower energy, in at most `iterations` steps of L-BFGS (Ceres). The
// energy never rises. They end near the surface, not on it.
void minimise_cvt(const WeightedSamples& samples, const std::vector<char>& held, int iterations,
                  const RunContext& context, std::vector<Eigen::Vector3d>& sites);

}  // namespace skinframe
