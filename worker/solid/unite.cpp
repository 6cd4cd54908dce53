// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/solid/unite.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "worker/mesh/append.h"
#include "worker/solid/exact_union.h"
#include "worker/solid/half_edges.h"
#include "worker/solid/level_set_union.h"
#include "worker/solid/self_intersections.h"
#include "worker/solid/shells.h"

namespace skinframe {
namespace {

// Corefinement of more than this takes too long.
constexpr std::size_t kMostExactBodies = 200, kMostExactTriangles = 1'000'000;

// Cleaning a surface of its own crossings looks, on each triangle, at every pair of the others that cut it:
// the sum of those squares is bounded. 338 crossings of a scan come to some 2000.
constexpr std::size_t kMostSelfWork = 20'000;

// How far the volume of an exact union may be from what the level set says: the error of the latter.
constexpr double kExactAgreement = 0.005;

TriangleMesh part_of(const TriangleMesh& mesh, const std::vector<int>& triangles) {
  // Of a surface in many parts each takes as long as it is itself, not as the whole.
  std::vector<int> used;
  used.reserve(3 * triangles.size());
  for (const int t : triangles) used.insert(used.end(), mesh.triangles[t].begin(), mesh.triangles[t].end());
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  TriangleMesh part;
  part.vertices.reserve(used.size());
  for (const int v : used) part.vertices.push_back(mesh.vertices[v]);
  part.triangles.reserve(triangles.size());
  for (const int t : triangles) {
    std::array<int, 3> own{};
    for (int k = 0; k < 3; ++k)
      own[k] =
          static_cast<int>(std::lower_bound(used.begin(), used.end(), mesh.triangles[t][k]) - used.begin());
    part.triangles.push_back(own);
  }
  return part;
}

// Shells that cross, by the numbers of the shells; a cavity goes with the body around it.
class Clusters {
 public:
  Clusters(const TriangleMesh& mesh, std::vector<Shell> shells, const std::vector<std::pair<int, int>>& pairs)
      : shells_(std::move(shells)),
        sets_(shells_.size()),
        self_pairs_(shells_.size(), 0),
        crossed_(shells_.size(), 0) {
    std::vector<int> shell_of(mesh.triangles.size(), 0);
    for (std::size_t s = 0; s < shells_.size(); ++s) {
      for (const int t : shells_[s].triangles) shell_of[t] = static_cast<int>(s);
    }
    std::map<int, std::size_t> cuts_of_triangle;
    for (const auto& [a, b] : pairs) {
      const int s = shell_of[a], t = shell_of[b];
      if (s == t) {
        ++self_pairs_[s];
        for (const int triangle : {a, b}) self_work_ += 2 * cuts_of_triangle[triangle]++ + 1;
      } else {
        sets_.join(s, t);
        crossed_[s] = crossed_[t] = 1;
      }
    }
    for (std::size_t s = 0; s < shells_.size(); ++s) {
      if (shells_[s].volume >= 0) continue;
      int around = -1;
      for (std::size_t o = 0; o < shells_.size(); ++o) {
        if (shells_[o].volume <= 0 || !contains(mesh, shells_[o], shells_[s])) continue;
        if (around < 0 || shells_[o].volume < shells_[around].volume) around = static_cast<int>(o);
      }
      if (around >= 0) sets_.join(static_cast<int>(s), around);
    }
  }

  const std::vector<Shell>& shells() const { return shells_; }
  std::size_t self_pairs(int shell) const { return self_pairs_[shell]; }
  // The sum of the squares of how often each triangle is cut by its own shell.
  std::size_t self_work() const { return self_work_; }

  struct Cluster {
    std::vector<int> shells;
    bool crosses = false;  // two of its shells cross
    std::size_t self_pairs = 0;
  };
  std::vector<Cluster> list() {
    std::map<int, Cluster> by_root;
    for (int s = 0; s < static_cast<int>(shells_.size()); ++s) {
      Cluster& cluster = by_root[sets_.find(s)];
      cluster.shells.push_back(s);
      cluster.crosses = cluster.crosses || crossed_[s];
      cluster.self_pairs += self_pairs_[s];
    }
    std::vector<Cluster> clusters;
    for (auto& [root, cluster] : by_root) clusters.push_back(std::move(cluster));
    return clusters;
  }

 private:
  std::vector<Shell> shells_;
  DisjointSets sets_;
  std::vector<std::size_t> self_pairs_;
  std::size_t self_work_ = 0;
  std::vector<char> crossed_;
};

// The bodies of a cluster with the cavities in them; a cavity that lies in none cuts into all.
std::vector<LevelSetBody> bodies_of(const TriangleMesh& mesh, const std::vector<Shell>& shells,
                                    const std::vector<int>& cluster) {
  std::vector<LevelSetBody> bodies;
  std::vector<int> outer;
  for (const int s : cluster) {
    if (shells[s].volume < 0) continue;
    outer.push_back(s);
    bodies.push_back({part_of(mesh, shells[s].triangles), {}});
  }
  for (const int s : cluster) {
    if (shells[s].volume >= 0) continue;
    int around = -1;
    for (std::size_t b = 0; b < outer.size(); ++b) {
      if (!contains(mesh, shells[outer[b]], shells[s])) continue;
      if (around < 0 || shells[outer[b]].volume < shells[outer[around]].volume) around = static_cast<int>(b);
    }
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      if (around < 0 || static_cast<int>(b) == around)
        bodies[b].cavities.push_back(part_of(mesh, shells[s].triangles));
    }
  }
  return bodies;
}

double volume_of(const std::vector<Shell>& shells, const std::vector<int>& cluster) {
  double volume = 0;
  for (const int s : cluster) volume += shells[s].volume;
  return volume;
}

struct United {
  TriangleMesh mesh;
  double voxel = 0;  // 0: exact
};

United unite(const TriangleMesh& mesh, const std::vector<Shell>& shells, const Clusters::Cluster& cluster,
             bool exact, const RunContext& context) {
  const std::vector<LevelSetBody> bodies = bodies_of(mesh, shells, cluster.shells);
  std::size_t triangles = 0;
  double largest = 0, sum = 0, area = 0;
  BoundingBox box = shells[cluster.shells.front()].box;
  std::vector<TriangleMesh> meshes;
  for (const LevelSetBody& body : bodies) {
    TriangleMesh whole = body.outer;
    for (const TriangleMesh& cavity : body.cavities) append(whole, cavity);
    triangles += whole.triangles.size();
    area += surface_area(whole);
    largest = std::max(largest, signed_volume(whole));
    sum += signed_volume(whole);
    const BoundingBox own = bounding_box(whole);
    box.min = box.min.cwiseMin(own.min);
    box.max = box.max.cwiseMax(own.max);
    meshes.push_back(std::move(whole));
  }
  if (exact && meshes.size() > 1 && meshes.size() <= kMostExactBodies && triangles <= kMostExactTriangles) {
    if (auto united = unite_exactly(meshes, context)) {
      const double volume = signed_volume(*united);
      // Between its largest body and all of them: what lies outside was not a union.
      constexpr double kRounding = 1e-6;
      if (volume >= largest * (1 - kRounding) && volume <= sum * (1 + kRounding))
        return {std::move(*united), 0};
    }
  }
  const double voxel = level_set_voxel(area, box.extent().norm());
  return {level_set_union(bodies, voxel, context), voxel};
}

std::string self_crossing(std::size_t pairs) {
  return fmt::format("{} of triangles cut each other",
                     pairs == 1 ? "1 pair" : fmt::format("{} pairs", pairs));
}

}  // namespace

Result<Union> unite_overlaps(const TriangleMesh& mesh, const UniteOptions& options,
                             const RunContext& context) {
  Union outcome;
  const auto pairs = find_self_intersections(mesh);
  if (pairs.empty()) return outcome;
  Clusters clusters(mesh, find_shells(mesh), pairs);
  std::size_t accepted_pairs = 0;
  double accepted_overlap = 0;
  for (const Clusters::Cluster& cluster : clusters.list()) {
    if (context.cancelled()) return cancelled_error();
    const double before = volume_of(clusters.shells(), cluster.shells);
    std::vector<int> triangles;
    for (const int s : cluster.shells)
      triangles.insert(triangles.end(), clusters.shells()[s].triangles.begin(),
                       clusters.shells()[s].triangles.end());
    const auto keep = [&] { append(outcome.mesh, part_of(mesh, triangles)); };
    if (cluster.crosses) {
      const United united = unite(mesh, clusters.shells(), cluster, options.exact, context);
      if (context.cancelled()) return cancelled_error();
      outcome.repairs.push_back(fmt::format(
          "united {} shells that overlap{}: their volumes add up to {:.6g} mm3 and enclose {:.6g} mm3",
          cluster.shells.size(),
          united.voxel > 0
              ? fmt::format(" in a level set of {:.2g} mm, which rounds edges by half of it", united.voxel)
              : "",
          before, signed_volume(united.mesh)));
      append(outcome.mesh, united.mesh);
      outcome.changed = true;
      continue;
    }
    if (cluster.self_pairs == 0) {
      keep();
      continue;
    }
    // Cut and cleaned where the library can; else slight crossings are left alone, since the surface is the
    // user's own, and what they change is measured.
    double sum = 0, shut_off = 0;
    bool clean = options.exact && clusters.self_work() <= kMostSelfWork;
    TriangleMesh cleaned;
    for (const int s : cluster.shells) {
      TriangleMesh shell = part_of(mesh, clusters.shells()[s].triangles);
      if (clusters.self_pairs(s) > 0) {
        const double voxel = level_set_voxel(surface_area(shell), bounding_box(shell).extent().norm());
        const double own = shut_off_volume(shell, voxel);
        sum += std::abs(clusters.shells()[s].volume);
        shut_off += own;
        auto united = clean ? unite_with_itself(shell) : std::nullopt;
        clean = united && std::abs(std::abs(signed_volume(*united)) - own) <= kExactAgreement * own;
        if (clean) shell = std::move(*united);
      }
      append(cleaned, shell);
    }
    if (clean) {
      outcome.repairs.push_back(
          fmt::format("united a surface with itself where {}: its triangles add up to {:.6g} mm3 and enclose "
                      "{:.6g} mm3",
                      self_crossing(cluster.self_pairs), before, signed_volume(cleaned)));
      append(outcome.mesh, cleaned);
      outcome.changed = true;
      continue;
    }
    const double overlap = shut_off > 0 ? std::abs(sum - shut_off) / shut_off : 0;
    if (overlap <= options.max_self_overlap_relative) {
      accepted_pairs += cluster.self_pairs;
      accepted_overlap = std::max(accepted_overlap, overlap);
      keep();
      continue;
    }
    const United united = unite(mesh, clusters.shells(), cluster, false, context);
    outcome.repairs.push_back(fmt::format(
        "united a surface with itself ({}) in a level set of {:.2g} mm, which rounds edges by half "
        "of it: its triangles add up to {:.6g} mm3 and enclose {:.6g} mm3",
        self_crossing(cluster.self_pairs), united.voxel, before, signed_volume(united.mesh)));
    append(outcome.mesh, united.mesh);
    outcome.changed = true;
  }
  if (accepted_pairs > 0) {
    outcome.warnings.push_back(
        fmt::format("{}; accepted as it is, since the volume that is enclosed twice or inside out is {} %",
                    self_crossing(accepted_pairs),
                    accepted_overlap < 1e-3 ? "below 0.1" : fmt::format("{:.1f}", 100 * accepted_overlap)));
  }
  return outcome;
}

}  // namespace skinframe
