// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/export/untangle.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "worker/export/crossings.h"

namespace skinframe {
namespace {

constexpr int kRoundsARing = 2;  // after as many the next ring of neighbours moves too
constexpr double kCellMm = 2.0;  // of the grid that finds who is near

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

void relax(TriangleMesh& mesh, const std::vector<char>& marked, const Hold& hold, int round) {
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
    hold(mesh.vertices[v], round);
  }
}

// The cells of that width which the triangle's box touches.
template <class Visit>
void for_each_cell(const TriangleMesh& mesh, const std::array<int, 3>& t, Visit visit) {
  const auto &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
  const auto cell = [](const Eigen::Vector3d& p) -> Eigen::Vector3i {
    return (p / kCellMm).array().floor().cast<int>();
  };
  const Eigen::Vector3i low = cell(a.cwiseMin(b).cwiseMin(c)), high = cell(a.cwiseMax(b).cwiseMax(c));
  const auto bits = [](int x) { return static_cast<std::uint64_t>(x + (1 << 20)) & ((1u << 21) - 1); };
  for (int x = low.x(); x <= high.x(); ++x)
    for (int y = low.y(); y <= high.y(); ++y)
      for (int z = low.z(); z <= high.z(); ++z)
        if (!visit(bits(x) << 42 | bits(y) << 21 | bits(z))) return;
}

// All triangles that may meet one with a marked corner.
std::vector<int> triangles_near(const TriangleMesh& mesh, const std::vector<char>& marked) {
  std::unordered_set<std::uint64_t> cells;
  for (const auto& t : mesh.triangles) {
    if (!marked[t[0]] && !marked[t[1]] && !marked[t[2]]) continue;
    for_each_cell(mesh, t, [&](std::uint64_t key) {
      cells.insert(key);
      return true;
    });
  }
  std::vector<int> near;
  for (int i = 0; i < static_cast<int>(mesh.triangles.size()); ++i) {
    for_each_cell(mesh, mesh.triangles[i], [&](std::uint64_t key) {
      if (!cells.contains(key)) return true;
      near.push_back(i);
      return false;
    });
  }
  return near;
}

}  // namespace

Untangling untangle(TriangleMesh& mesh, const RunContext& context, const Hold& hold) {
  Untangling result;
  Pairs pairs = crossing_triangles(mesh);
  result.crossings_found = static_cast<int>(pairs.size());
  // Rounds may make more than they mend; what counts is the best of them.
  std::size_t fewest = pairs.size();
  std::vector<Eigen::Vector3d> best;
  if (fewest > 0) best = mesh.vertices;
  for (int round = 0; round < kMostUntanglingRounds && !pairs.empty() && !context.cancelled(); ++round) {
    std::vector<char> marked = corners_of(mesh, pairs);
    for (int ring = 0; ring < round / kRoundsARing; ++ring) add_ring(mesh, marked);
    relax(mesh, marked, hold, round);
    pairs = crossing_triangles(mesh, triangles_near(mesh, marked));
    if (pairs.size() >= fewest) continue;
    fewest = pairs.size();
    best = mesh.vertices;
  }
  if (pairs.size() > fewest) mesh.vertices = std::move(best);
  result.crossings_left = static_cast<int>(fewest);
  return result;
}

}  // namespace skinframe
