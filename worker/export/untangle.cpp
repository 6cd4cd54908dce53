// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/export/untangle.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_set>

#include "worker/export/crossings.h"

namespace skinframe {
namespace {

constexpr int kMostRounds = 24;
constexpr int kRoundsARing = 3;  // after as many the next ring of neighbours moves too

using Pairs = std::vector<std::pair<int, int>>;

std::vector<char> corners_of(const TriangleMesh& mesh, const Pairs& pairs) {
  std::vector<char> marked(mesh.vertices.size(), 0);
  for (const auto& [s, t] : pairs) {
    for (int v : mesh.triangles[s]) marked[v] = 1;
    for (int v : mesh.triangles[t]) marked[v] = 1;
  }
  return marked;
}

void add_ring(const TriangleMesh& mesh, std::vector<char>& marked) {
  const std::vector<char> before = marked;
  for (const auto& t : mesh.triangles) {
    if (before[t[0]] || before[t[1]] || before[t[2]]) marked[t[0]] = marked[t[1]] = marked[t[2]] = 1;
  }
}

void relax(TriangleMesh& mesh, const std::vector<char>& marked) {
  std::map<int, std::pair<Eigen::Vector3d, int>> sums;  // in order of the vertices
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      if (!marked[t[k]]) continue;
      auto& [sum, count] = sums.try_emplace(t[k], Eigen::Vector3d::Zero(), 0).first->second;
      sum += mesh.vertices[t[(k + 1) % 3]];  // each neighbour once: it follows in one triangle only
      ++count;
    }
  }
  for (const auto& [v, mean] : sums) {
    const Eigen::Vector3d to = 0.5 * (mesh.vertices[v] + mean.first / mean.second);
    mesh.vertices[v] = to.cast<float>().cast<double>();
  }
}

// All triangles that may meet one with a marked corner.
std::vector<int> triangles_near(const TriangleMesh& mesh, const std::vector<char>& marked) {
  double width = 0.0;
  std::vector<int> moved;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const auto& p = mesh.vertices;
    width = std::max({width, (p[a] - p[b]).norm(), (p[b] - p[c]).norm(), (p[c] - p[a]).norm()});
    if (marked[a] || marked[b] || marked[c]) moved.push_back(t);
  }
  // Triangles that meet have corners no further apart than two of the longest edges.
  width *= 2.0;
  const auto cell = [&](int v) -> Eigen::Vector3i {
    return (mesh.vertices[v] / width).array().floor().cast<int>();
  };
  const auto key = [](const Eigen::Vector3i& c) {
    const auto bits = [](int x) { return static_cast<std::uint64_t>(x + (1 << 20)) & ((1u << 21) - 1); };
    return bits(c.x()) << 42 | bits(c.y()) << 21 | bits(c.z());
  };
  std::unordered_set<std::uint64_t> cells;
  for (const int t : moved) {
    const Eigen::Vector3i at = cell(mesh.triangles[t][0]);
    for (int n = 0; n < 27; ++n) cells.insert(key(at + Eigen::Vector3i(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1)));
  }
  std::vector<int> near;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    if (cells.contains(key(cell(mesh.triangles[t][0])))) near.push_back(t);
  }
  return near;
}

}  // namespace

Untangling untangle(TriangleMesh& mesh, const RunContext& context) {
  Untangling result;
  Pairs pairs = crossing_triangles(mesh);
  result.crossings_found = static_cast<int>(pairs.size());
  for (int round = 0; round < kMostRounds && !pairs.empty() && !context.cancelled(); ++round) {
    std::vector<char> marked = corners_of(mesh, pairs);
    for (int ring = 0; ring < round / kRoundsARing; ++ring) add_ring(mesh, marked);
    relax(mesh, marked);
    pairs = crossing_triangles(mesh, triangles_near(mesh, marked));
  }
  result.crossings_left = static_cast<int>(pairs.size());
  return result;
}

}  // namespace skinframe
