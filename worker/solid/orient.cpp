// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/solid/orient.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

#include "worker/solid/half_edges.h"

namespace skinframe {
namespace {

std::string place_of(const Eigen::Vector3d& p) {
  return fmt::format("({:.4g}, {:.4g}, {:.4g})", p.x(), p.y(), p.z());
}

double area_of(const TriangleMesh& mesh, int t) {
  const auto& [a, b, c] = mesh.triangles[t];
  return (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm() / 2;
}

std::vector<int> mates_across_plain_edges(const TriangleMesh& mesh) {
  std::vector<int> mate(3 * mesh.triangles.size(), -1);
  const EdgeTable edges(mesh);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto h = edges.half_edges(e);
    if (h.size() != 2) continue;
    mate[h[0]] = h[1];
    mate[h[1]] = h[0];
  }
  return mate;
}

// A triangle at an edge of many, seen along the edge from its lower-numbered end.
struct Leaf {
  int half_edge = 0;
  bool forward = false;  // runs from the lower to the higher end
  double angle = 0;      // radians, counter-clockwise about that direction
};

// A forward triangle has its outside at larger angles and so its material at smaller ones; going down from
// it, the first backward triangle not yet taken bounds that material. Empty when they do not alternate.
std::vector<std::pair<int, int>> mate_around_edge(const TriangleMesh& mesh, std::span<const int> half_edges) {
  const int low = std::min(origin_of(mesh, half_edges[0]), target_of(mesh, half_edges[0]));
  const int high = std::max(origin_of(mesh, half_edges[0]), target_of(mesh, half_edges[0]));
  const Eigen::Vector3d axis = (mesh.vertices[high] - mesh.vertices[low]).normalized();
  const Eigen::Vector3d u = axis.unitOrthogonal();
  const Eigen::Vector3d v = axis.cross(u);
  std::vector<Leaf> leaves;
  for (const int h : half_edges) {
    const Eigen::Vector3d d = mesh.vertices[apex_of(mesh, h)] - mesh.vertices[low];
    leaves.push_back({h, origin_of(mesh, h) == low, std::atan2(d.dot(v), d.dot(u))});
  }
  std::sort(leaves.begin(), leaves.end(), [](const Leaf& a, const Leaf& b) { return a.angle < b.angle; });
  std::vector<std::pair<int, int>> mates;
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const Leaf& below = leaves[(i + leaves.size() - 1) % leaves.size()];
    if (leaves[i].forward == below.forward) return {};
    if (leaves[i].forward) mates.emplace_back(leaves[i].half_edge, below.half_edge);
  }
  return mates;
}

}  // namespace

Result<std::size_t> orient_patches(TriangleMesh& mesh) {
  const std::vector<int> mate = mates_across_plain_edges(mesh);
  const int count = static_cast<int>(mesh.triangles.size());
  std::vector<char> seen(count, 0);
  std::vector<char> turned(count, 0);
  std::size_t turned_count = 0;
  for (int seed = 0; seed < count; ++seed) {
    if (seen[seed]) continue;
    std::vector<int> patch{seed};
    seen[seed] = 1;
    double turned_area = 0, area = 0;
    for (std::size_t i = 0; i < patch.size(); ++i) {
      const int t = patch[i];
      const double own = area_of(mesh, t);
      area += own;
      turned_area += turned[t] ? own : 0;
      for (int h = 3 * t; h < 3 * t + 3; ++h) {
        if (mate[h] < 0) continue;
        const int other = triangle_of(mate[h]);
        // Neighbours agree when the edge runs the two opposite ways.
        const bool disagree = origin_of(mesh, h) == origin_of(mesh, mate[h]);
        const char wanted = static_cast<char>(turned[t] ^ (disagree ? 1 : 0));
        if (!seen[other]) {
          seen[other] = 1;
          turned[other] = wanted;
          patch.push_back(other);
        } else if (turned[other] != wanted) {
          return invalid_input(
              fmt::format("the surface is one-sided (non-orientable, like a Moebius strip) at the edge near "
                          "{}: it has no inside",
                          place_of(mesh.vertices[origin_of(mesh, h)])));
        }
      }
    }
    const bool all = turned_area > area / 2;
    for (const int t : patch) {
      turned[t] = static_cast<char>(turned[t] ^ (all ? 1 : 0));
      turned_count += turned[t];
    }
  }
  for (int t = 0; t < count; ++t) {
    if (turned[t]) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
  }
  return turned_count;
}

Result<PartCounts> part_touching_edges(TriangleMesh& mesh, double gap) {
  PartCounts counts;
  const EdgeTable edges(mesh);
  std::vector<char> touched(mesh.vertices.size(), 0);
  DisjointSets umbrellas(3 *
                         mesh.triangles.size());  // of corners; corner k of t is the origin of half-edge 3t+k
  const auto next = [](int h) { return h - h % 3 + (h % 3 + 1) % 3; };
  const auto join = [&](int h, int g) {
    umbrellas.join(h, next(g));
    umbrellas.join(next(h), g);
  };
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto h = edges.half_edges(e);
    if (h.size() == 2) join(h[0], h[1]);
    if (h.size() <= 2) continue;
    const int a = origin_of(mesh, h[0]), b = target_of(mesh, h[0]);
    const auto mates = mate_around_edge(mesh, h);
    if (mates.empty()) {
      return invalid_input(
          fmt::format("the edge from {} to {} is shared by {} triangles that bound no material between "
                      "them (an inner wall or a fin); remove it",
                      place_of(mesh.vertices[a]), place_of(mesh.vertices[b]), h.size()));
    }
    for (const auto& [forward, backward] : mates) join(forward, backward);
    touched[a] = touched[b] = 1;
    ++counts.edges;
  }
  if (counts.edges == 0) return counts;

  // The first umbrella of a vertex keeps its number; all of them step back from the common place.
  std::map<int, int> vertex_of_umbrella;
  std::vector<int> first_umbrella(mesh.vertices.size(), -1);
  std::map<int, Eigen::Vector3d> pull;  // towards the middle of the umbrella's opposite edges
  const std::size_t corner_count = 3 * mesh.triangles.size();
  const TriangleMesh before = mesh;
  for (std::size_t c = 0; c < corner_count; ++c) {
    const int corner = static_cast<int>(c);
    const int v = origin_of(before, corner);
    if (!touched[v]) continue;
    const int umbrella = umbrellas.find(corner);
    auto [place, is_new] = vertex_of_umbrella.try_emplace(umbrella, v);
    if (is_new) {
      if (first_umbrella[v] < 0) {
        first_umbrella[v] = umbrella;
      } else {
        place->second = static_cast<int>(mesh.vertices.size());
        mesh.vertices.push_back(before.vertices[v]);
        ++counts.vertices;
      }
    }
    mesh.triangles[corner / 3][corner % 3] = place->second;
    const Eigen::Vector3d middle =
        (before.vertices[target_of(before, corner)] + before.vertices[apex_of(before, corner)]) / 2;
    pull.try_emplace(place->second, Eigen::Vector3d::Zero()).first->second += middle - before.vertices[v];
  }
  for (const auto& [v, direction] : pull) {
    if (direction.norm() > 0) mesh.vertices[v] += gap * direction.normalized();
  }
  return counts;
}

}  // namespace skinframe
