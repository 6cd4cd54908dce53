// SPDX-License-Identifier: GPL-3.0-or-later
// Linear elasticity on quadratic tetrahedra (ten nodes, four integration points): good to the percent where
// constant strain is too stiff, as a reference for displacements. One factorisation, any number of cases.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "worker/stress/stress_map.h"

namespace skinframe {

struct SolidCase {
  std::string name;
  bool gravity = true;            // weight along -z
  std::vector<StressLoad> loads;  // spread by area over the surface within each load's radius
};

struct SolidAnswer {
  double max_displacement_mm = 0;
  Eigen::Vector3d at_mm = Eigen::Vector3d::Zero();
  double external_work_n_mm = 0;  // of the loads, weight left out
};

inline constexpr std::size_t kMaxQuadraticTets = 40000;

// held: of a surface point, whether it stays where it is. Of a mesh that falls apart the largest part counts.
// Errors: kInvalidInput when the mesh is too large, empty or not held; kCancelled.
Result<std::vector<SolidAnswer>> solve_quadratic_solid(
    const TetMesh& mesh, const ElasticMaterial& material, double weight_density_n_mm3,
    const std::function<bool(const Eigen::Vector3d&)>& held, const std::vector<SolidCase>& cases,
    const RunContext& context);

}  // namespace skinframe
