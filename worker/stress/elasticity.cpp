// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/stress/elasticity.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "worker/stress/isotropic.h"
#include "worker/stress/solve_held.h"

namespace skinframe {
namespace {

using StrainMatrix = Eigen::Matrix<double, 6, 12>;

// Strain from the displacements of the four corners.
StrainMatrix strain_matrix(const TetMesh& mesh, const std::array<int, 4>& tet) {
  Eigen::Matrix3d edges;
  for (int k = 0; k < 3; ++k)
    edges.row(k) = (mesh.vertices_mm[tet[k + 1]] - mesh.vertices_mm[tet[0]]).transpose();
  Eigen::Matrix<double, 3, 4> gradient;  // of the four shape functions
  gradient.rightCols<3>() = edges.inverse();
  gradient.col(0) = -gradient.rightCols<3>().rowwise().sum();
  StrainMatrix b = StrainMatrix::Zero();
  for (int i = 0; i < 4; ++i) {
    const double x = gradient(0, i), y = gradient(1, i), z = gradient(2, i);
    b.block<6, 3>(0, 3 * i) << x, 0, 0, 0, y, 0, 0, 0, z, y, x, 0, 0, z, y, z, 0, x;
  }
  return b;
}

// Vertices of no tetrahedron have no unknowns.
std::vector<char> free_axes(const TetMesh& mesh, const Prescribed& prescribed) {
  std::vector<char> free(3 * mesh.vertices_mm.size(), 0);
  for (const auto& tet : mesh.tets)
    for (const int v : tet)
      if (!prescribed[v]) std::fill_n(free.begin() + 3 * v, 3, 1);
  return free;
}

std::vector<std::pair<int, int>> links_of(const TetMesh& mesh) {
  std::vector<std::pair<int, int>> links;
  links.reserve(mesh.tets.size() * 6);
  for (const auto& tet : mesh.tets)
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < i; ++j) links.emplace_back(tet[i], tet[j]);
  return links;
}

}  // namespace

Result<std::vector<ElasticResponse>> solve_elasticity(const TetMesh& mesh, const ElasticMaterial& material,
                                                      const Prescribed& prescribed,
                                                      const std::vector<NodalVectors>& forces_n,
                                                      const RunContext& context) {
  const std::size_t n = mesh.vertices_mm.size();
  SKINFRAME_CHECK(prescribed.size() == n);
  for (const auto& forces : forces_n) SKINFRAME_CHECK(forces.size() == n);
  if (n > kMaxElasticVertices)
    return invalid_input(fmt::format("{} vertices of tetrahedra, more than {}", n, kMaxElasticVertices));

  NodeMatrix stiffness(3, free_axes(mesh, prescribed), links_of(mesh));
  std::vector<int> first_row;
  for (std::size_t v = 0; v < n; ++v) first_row.push_back(stiffness.row(3 * v));
  const auto d = isotropic_stiffness(material);
  const int cases = static_cast<int>(forces_n.size());
  Eigen::MatrixXd rhs = Eigen::MatrixXd::Zero(stiffness.rows(), cases);
  for (int c = 0; c < cases; ++c)
    for (std::size_t v = 0; v < n; ++v)
      if (first_row[v] >= 0) rhs.block<3, 1>(first_row[v], c) = forces_n[c][v];

  for (const auto& tet : mesh.tets) {
    const StrainMatrix b = strain_matrix(mesh, tet);
    const Eigen::Matrix<double, 12, 12> k = tet_volume_mm3(mesh, tet) * b.transpose() * d * b;
    stiffness.add(tet, k);
    for (int j = 0; j < 4; ++j) {
      if (!prescribed[tet[j]]) continue;
      for (int i = 0; i < 4; ++i)
        if (const int row = first_row[tet[i]]; row >= 0)
          rhs.middleRows<3>(row).colwise() -= k.block<3, 3>(3 * i, 3 * j) * *prescribed[tet[j]];
    }
  }
  auto solved = solve_held(
      std::move(stiffness), [&] { return std::move(rhs); }, context);
  if (!solved) return solved.error();
  const Eigen::MatrixXd& solution = *solved;
  if (context.cancelled()) return cancelled_error();

  std::vector<ElasticResponse> responses(cases);
  for (int c = 0; c < cases; ++c) {
    auto& [displacement, stress] = responses[c];
    displacement.resize(n, Eigen::Vector3d::Zero());
    for (std::size_t v = 0; v < n; ++v) {
      if (first_row[v] >= 0)
        displacement[v] = solution.block<3, 1>(first_row[v], c);
      else if (prescribed[v])
        displacement[v] = *prescribed[v];
    }
    for (const auto& tet : mesh.tets) {
      Eigen::Matrix<double, 12, 1> u;
      for (int i = 0; i < 4; ++i) u.segment<3>(3 * i) = displacement[tet[i]];
      stress.push_back(d * (strain_matrix(mesh, tet) * u));
    }
  }
  return responses;
}

double von_mises_mpa(const StressTensor& s) {
  const double xy = s[0] - s[1], yz = s[1] - s[2], zx = s[2] - s[0];
  return std::sqrt(0.5 * (xy * xy + yz * yz + zx * zx) + 3.0 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

}  // namespace skinframe
