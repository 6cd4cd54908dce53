// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/solid/stitch.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "worker/solid/half_edges.h"

namespace skinframe {
namespace {

constexpr std::size_t kMostBoundaryEdges = 10'000;
constexpr int kMostPasses = 8;  // one a side of a triangle, and what splitting brings to light

// Vertices on the inside of the edge, in its sense.
std::vector<int> vertices_along(const TriangleMesh& mesh, int from, int to,
                                const std::vector<int>& candidates, double tolerance) {
  const Eigen::Vector3d& a = mesh.vertices[from];
  const Eigen::Vector3d ab = mesh.vertices[to] - a;
  const double length = ab.norm();
  std::vector<std::pair<double, int>> found;
  if (length <= 2 * tolerance) return {};
  const Eigen::Vector3d along = ab / length;
  for (const int v : candidates) {
    if (v == from || v == to) continue;
    const Eigen::Vector3d av = mesh.vertices[v] - a;
    const double s = av.dot(along);
    if (s <= tolerance || s >= length - tolerance) continue;
    if ((av - s * along).squaredNorm() <= tolerance * tolerance) found.emplace_back(s, v);
  }
  std::sort(found.begin(), found.end());
  std::vector<int> vertices;
  for (const auto& [s, v] : found) vertices.push_back(v);
  return vertices;
}

}  // namespace

std::size_t split_at_touching_vertices(TriangleMesh& mesh, double tolerance) {
  std::size_t splits = 0;
  for (int pass = 0; pass < kMostPasses; ++pass) {
    std::vector<int> open, rim;
    const EdgeTable edges(mesh);
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const auto h = edges.half_edges(e);
      if (h.size() != 1) continue;
      open.push_back(h[0]);
      rim.push_back(origin_of(mesh, h[0]));
      rim.push_back(target_of(mesh, h[0]));
    }
    if (open.empty() || open.size() > kMostBoundaryEdges) return splits;
    std::sort(open.begin(), open.end());
    std::sort(rim.begin(), rim.end());
    rim.erase(std::unique(rim.begin(), rim.end()), rim.end());
    std::vector<char> split(mesh.triangles.size(), 0);
    std::size_t now = 0;
    for (const int h : open) {
      const int t = triangle_of(h);
      if (split[t]) continue;  // another side of it, in the next pass
      const int a = origin_of(mesh, h), b = target_of(mesh, h), apex = apex_of(mesh, h);
      std::vector<int> chain = vertices_along(mesh, a, b, rim, tolerance);
      std::erase(chain, apex);
      if (chain.empty()) continue;
      split[t] = 1;
      now += chain.size();
      chain.push_back(b);
      mesh.triangles[t] = {a, chain[0], apex};
      for (std::size_t i = 0; i + 1 < chain.size(); ++i)
        mesh.triangles.push_back({chain[i], chain[i + 1], apex});
    }
    if (now == 0) return splits;
    splits += now;
  }
  return splits;
}

}  // namespace skinframe
