// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/solid/sheets.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "worker/solid/half_edges.h"
#include "worker/solid/orient.h"

namespace skinframe {
namespace {

// Each candidate is tried on a copy of the mesh. A body with a few walls takes far less than this many visits
// of a triangle; what is left then is for the steps that follow to refuse.
constexpr std::size_t kMostVisits = 50'000'000;

struct Patches {
  std::vector<int> of_triangle;  // a triangle's patch, named by its lowest triangle
  std::set<int> at_odd_edge;     // patches at an edge of three, five, ... triangles
  std::set<int> open;            // patches with an edge of one triangle
  std::size_t odd_edges = 0;     // of one triangle too
};

Patches find_patches(const TriangleMesh& mesh) {
  Patches patches;
  DisjointSets sets(mesh.triangles.size());
  const EdgeTable edges(mesh);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto h = edges.half_edges(e);
    if (h.size() == 2) sets.join(triangle_of(h[0]), triangle_of(h[1]));
  }
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t)
    patches.of_triangle.push_back(sets.find(t));
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto h = edges.half_edges(e);
    patches.odd_edges += h.size() % 2;
    if (h.size() == 1) patches.open.insert(patches.of_triangle[triangle_of(h[0])]);
    if (h.size() % 2 == 0 || h.size() == 1) continue;
    for (const int half_edge : h) patches.at_odd_edge.insert(patches.of_triangle[triangle_of(half_edge)]);
  }
  return patches;
}

std::size_t drop_patches(TriangleMesh& mesh, const std::vector<int>& of_triangle,
                         const std::set<int>& dropped) {
  std::size_t kept = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (dropped.count(of_triangle[t]) == 0) mesh.triangles[kept++] = mesh.triangles[t];
  }
  const std::size_t gone = mesh.triangles.size() - kept;
  mesh.triangles.resize(kept);
  drop_unused_vertices(mesh);
  return gone;
}

// What is left without the patch: how many odd edges, and how much it encloses. Empty where it has no sides.
std::optional<std::pair<std::size_t, double>> without(const TriangleMesh& mesh, const Patches& patches,
                                                      int patch) {
  TriangleMesh rest = mesh;
  drop_patches(rest, patches.of_triangle, {patch});
  if (!orient_patches(rest).ok()) return std::nullopt;
  return std::pair(find_patches(rest).odd_edges, -std::abs(signed_volume(rest)));
}

int smallest_of(const TriangleMesh& mesh, const Patches& patches, const std::set<int>& candidates) {
  std::map<int, double> area;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const int patch = patches.of_triangle[t];
    if (candidates.count(patch) == 0) continue;
    const auto& [a, b, c] = mesh.triangles[t];
    const Eigen::Vector3d& p = mesh.vertices[a];
    area[patch] += (mesh.vertices[b] - p).cross(mesh.vertices[c] - p).norm();
  }
  return std::min_element(area.begin(), area.end(),
                          [](const auto& x, const auto& y) { return x.second < y.second; })
      ->first;
}

}  // namespace

SheetCounts drop_sheets(TriangleMesh& mesh) {
  SheetCounts counts;
  std::size_t visits = 0;
  while (visits < kMostVisits) {
    const Patches patches = find_patches(mesh);
    if (patches.at_odd_edge.empty()) return counts;
    visits += mesh.triangles.size();
    std::set<int> fins;
    std::set_intersection(patches.at_odd_edge.begin(), patches.at_odd_edge.end(), patches.open.begin(),
                          patches.open.end(), std::inserter(fins, fins.end()));
    if (!fins.empty()) {
      // A body with a hole and a fin is open too: of open patches alone, the smallest is the fin.
      if (fins.size() == patches.at_odd_edge.size()) fins = {smallest_of(mesh, patches, fins)};
      counts.fins += drop_patches(mesh, patches.of_triangle, fins);
      continue;
    }
    visits += patches.at_odd_edge.size() * mesh.triangles.size();
    if (visits > kMostVisits) return counts;
    std::optional<std::pair<std::size_t, double>> best;
    int best_patch = -1;
    for (const int patch : patches.at_odd_edge) {
      const auto rest = without(mesh, patches, patch);
      if (rest && rest->first < patches.odd_edges && (!best || *rest < *best)) {
        best = rest;
        best_patch = patch;
      }
    }
    if (!best) return counts;
    counts.walls += drop_patches(mesh, patches.of_triangle, {best_patch});
  }
  return counts;
}

}  // namespace skinframe
