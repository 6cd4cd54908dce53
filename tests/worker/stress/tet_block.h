// SPDX-License-Identifier: GPL-3.0-or-later
// A block of cubes, six tetrahedra each (Kuhn's division), for closed forms.
#pragma once

#include <Eigen/Geometry>

#include "worker/stress/tet_mesh.h"

namespace skinframe::test {

inline TetMesh tet_block(const Eigen::Vector3i& cells, const Eigen::Vector3d& size_mm) {
  TetMesh mesh;
  const auto vertex = [&](const Eigen::Vector3i& p) {
    return p.x() + (cells.x() + 1) * (p.y() + (cells.y() + 1) * p.z());
  };
  for (int z = 0; z <= cells.z(); ++z)
    for (int y = 0; y <= cells.y(); ++y)
      for (int x = 0; x <= cells.x(); ++x)
        mesh.vertices_mm.push_back(
            Eigen::Vector3d(x, y, z).cwiseQuotient(cells.cast<double>()).cwiseProduct(size_mm));
  constexpr int kOrders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (int z = 0; z < cells.z(); ++z)
    for (int y = 0; y < cells.y(); ++y)
      for (int x = 0; x < cells.x(); ++x)
        for (const auto& order : kOrders) {
          Eigen::Vector3i p(x, y, z);
          std::array<int, 4> tet{vertex(p), 0, 0, 0};
          for (int k = 0; k < 3; ++k) {
            ++p[order[k]];
            tet[k + 1] = vertex(p);
          }
          if (tet_volume_mm3(mesh, tet) < 0.0) std::swap(tet[2], tet[3]);
          mesh.tets.push_back(tet);
        }
  return mesh;
}

}  // namespace skinframe::test
