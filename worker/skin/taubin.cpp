// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/skin/taubin.h"

#include <vector>

namespace skinframe {
namespace {

// In the order of the triangles: the same sums at any thread count.
void step(TriangleMesh& mesh, double share, const std::vector<int>& degree,
          std::vector<Eigen::Vector3d>& sums) {
  sums.assign(mesh.vertices.size(), Eigen::Vector3d::Zero());
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) sums[t[k]] += mesh.vertices[t[(k + 1) % 3]];
  for (std::size_t v = 0; v < sums.size(); ++v)
    if (degree[v] > 0) mesh.vertices[v] += share * (sums[v] / degree[v] - mesh.vertices[v]);
}

}  // namespace

void fair_taubin(TriangleMesh& mesh, int pairs) {
  std::vector<int> degree(mesh.vertices.size(), 0);
  for (const auto& t : mesh.triangles)
    for (const int v : t) ++degree[v];  // on a closed mesh each neighbour follows in one triangle
  std::vector<Eigen::Vector3d> sums;
  for (int pair = 0; pair < pairs; ++pair) {
    step(mesh, kTaubinLambda, degree, sums);
    step(mesh, kTaubinMu, degree, sums);
  }
}

}  // namespace skinframe
