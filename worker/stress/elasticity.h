// SPDX-License-Identifier: GPL-3.0-or-later
// Linear elasticity on tetrahedra of constant strain, isotropic:  sigma = lambda tr(eps) I + 2 mu eps,
// lambda = E nu / ((1 + nu)(1 - 2 nu)), mu = E / (2 (1 + nu)). One factorisation (CHOLMOD), any number of
// load cases. Elements of constant strain are too stiff in bending, by a seventh with six across a beam: good
// enough to say where stress is, not how large it is to the percent.
#pragma once

#include <optional>

#include "worker/run/run_context.h"
#include "worker/stress/tet_mesh.h"

namespace skinframe {

struct ElasticMaterial {
  double modulus_mpa = 0.0;     // E, > 0
  double poisson_ratio = 0.35;  // nu, in [0, 0.49]
};

using NodalVectors = std::vector<Eigen::Vector3d>;               // one a vertex
using Prescribed = std::vector<std::optional<Eigen::Vector3d>>;  // displacement in mm, one a vertex
using StressTensor = Eigen::Matrix<double, 6, 1>;                // xx yy zz xy yz zx, MPa

struct ElasticResponse {
  NodalVectors displacement_mm;
  std::vector<StressTensor> stress_mpa;  // one a tetrahedron
};

inline constexpr std::size_t kMaxElasticVertices = 200000;

// forces_n: one list a load case. Vertices of no tetrahedron stay where they are. Errors: kInvalidInput when
// the mesh is too large or not held (the factorisation meets a pivot that is not positive); kCancelled.
Result<std::vector<ElasticResponse>> solve_elasticity(const TetMesh& mesh, const ElasticMaterial& material,
                                                      const Prescribed& prescribed,
                                                      const std::vector<NodalVectors>& forces_n,
                                                      const RunContext& context);

double von_mises_mpa(const StressTensor& stress);

}  // namespace skinframe
