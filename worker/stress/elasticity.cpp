// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/stress/elasticity.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <Eigen/Sparse>
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

struct Unknowns {
  std::vector<int> first;  // of a vertex; -1 when it is prescribed or in no tetrahedron
  int count = 0;
};

Unknowns number_unknowns(const TetMesh& mesh, const Prescribed& prescribed) {
  Unknowns unknowns{std::vector<int>(mesh.vertices_mm.size(), -1), 0};
  std::vector<char> used(mesh.vertices_mm.size(), 0);
  for (const auto& tet : mesh.tets)
    for (const int v : tet) used[v] = 1;
  for (std::size_t v = 0; v < used.size(); ++v) {
    if (!used[v] || prescribed[v]) continue;
    unknowns.first[v] = unknowns.count;
    unknowns.count += 3;
  }
  return unknowns;
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

  const Unknowns unknowns = number_unknowns(mesh, prescribed);
  const auto d = isotropic_stiffness(material);
  const int cases = static_cast<int>(forces_n.size());
  Eigen::MatrixXd rhs = Eigen::MatrixXd::Zero(unknowns.count, cases);
  for (int c = 0; c < cases; ++c)
    for (std::size_t v = 0; v < n; ++v)
      if (unknowns.first[v] >= 0) rhs.block<3, 1>(unknowns.first[v], c) = forces_n[c][v];

  std::vector<Eigen::Triplet<double>> entries;  // of the lower half
  entries.reserve(mesh.tets.size() * 84);
  for (const auto& tet : mesh.tets) {
    const StrainMatrix b = strain_matrix(mesh, tet);
    const Eigen::Matrix<double, 12, 12> k = tet_volume_mm3(mesh, tet) * b.transpose() * d * b;
    for (int i = 0; i < 4; ++i) {
      const int row = unknowns.first[tet[i]];
      if (row < 0) continue;
      for (int j = 0; j < 4; ++j) {
        const int column = unknowns.first[tet[j]];
        if (column < 0) {
          if (prescribed[tet[j]])
            rhs.middleRows<3>(row).colwise() -= k.block<3, 3>(3 * i, 3 * j) * *prescribed[tet[j]];
          continue;
        }
        for (int p = 0; p < 3; ++p)
          for (int q = 0; q < 3; ++q)
            if (row + p >= column + q) entries.emplace_back(row + p, column + q, k(3 * i + p, 3 * j + q));
      }
    }
  }
  Eigen::MatrixXd solution = Eigen::MatrixXd::Zero(unknowns.count, cases);
  if (unknowns.count > 0) {
    auto solved = solve_held(std::move(entries), rhs, context);
    if (!solved) return solved.error();
    solution = std::move(solved).value();
  }
  if (context.cancelled()) return cancelled_error();

  std::vector<ElasticResponse> responses(cases);
  for (int c = 0; c < cases; ++c) {
    auto& [displacement, stress] = responses[c];
    displacement.resize(n, Eigen::Vector3d::Zero());
    for (std::size_t v = 0; v < n; ++v) {
      if (unknowns.first[v] >= 0)
        displacement[v] = solution.block<3, 1>(unknowns.first[v], c);
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
