// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/skin/taubin.h"

#include <tbb/parallel_for.h>

#include <numeric>
#include <utility>
#include <vector>

namespace skinframe {
namespace {

// The neighbours of each vertex in the order of the triangles, which the sums keep to: the same at any thread
// count. On a closed mesh each follows the vertex in one triangle.
struct Neighbours {
  std::vector<int> first, of;

  explicit Neighbours(const TriangleMesh& mesh) : first(mesh.vertices.size() + 1, 0) {
    for (const auto& t : mesh.triangles)
      for (const int v : t) ++first[v + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    of.resize(3 * mesh.triangles.size());
    std::vector<int> next = first;
    for (const auto& t : mesh.triangles)
      for (int k = 0; k < 3; ++k) of[next[t[k]]++] = t[(k + 1) % 3];
  }
};

void step(const std::vector<Eigen::Vector3d>& from, double share, const Neighbours& neighbours,
          std::vector<Eigen::Vector3d>& to) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, from.size(), 4096), [&](const auto& range) {
    for (std::size_t v = range.begin(); v < range.end(); ++v) {
      const int first = neighbours.first[v], end = neighbours.first[v + 1];
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (int i = first; i < end; ++i) sum += from[neighbours.of[i]];
      to[v] = from[v];
      if (end > first) to[v] += share * (sum / (end - first) - from[v]);
    }
  });
}

}  // namespace

void fair_taubin(TriangleMesh& mesh, int pairs) {
  const Neighbours neighbours(mesh);
  std::vector<Eigen::Vector3d> between(mesh.vertices.size());
  for (int pair = 0; pair < pairs; ++pair) {
    step(mesh.vertices, kTaubinLambda, neighbours, between);
    step(between, kTaubinMu, neighbours, mesh.vertices);
  }
}

}  // namespace skinframe
