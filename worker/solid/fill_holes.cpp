// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/solid/fill_holes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <unordered_map>
#include <unordered_set>

#include "worker/solid/half_edges.h"
#include "worker/solid/hole_patch.h"

namespace skinframe {
namespace {

Opening make_opening(const TriangleMesh& mesh, std::vector<int> loop) {
  Opening opening;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Eigen::Vector3d& p = mesh.vertices[loop[i]];
    opening.length += (mesh.vertices[loop[(i + 1) % loop.size()]] - p).norm();
    opening.middle += p / static_cast<double>(loop.size());
  }
  opening.loop = std::move(loop);
  return opening;
}

// The edges that exist, between vertices either way round; grows with what is filled.
class EdgeSet {
 public:
  explicit EdgeSet(const TriangleMesh& mesh) {
    keys_.reserve(2 * mesh.triangles.size());
    for (const auto& t : mesh.triangles) add(t);
  }
  void add(const std::array<int, 3>& t) {
    for (int k = 0; k < 3; ++k) keys_.insert(key(t[k], t[(k + 1) % 3]));
  }
  bool contains(int a, int b) const { return keys_.count(key(a, b)) > 0; }

 private:
  static std::uint64_t key(int a, int b) {
    return static_cast<std::uint64_t>(std::min(a, b)) << 32 | static_cast<std::uint32_t>(std::max(a, b));
  }
  std::unordered_set<std::uint64_t> keys_;
};

// Each edge of the loop once in the loop's sense, each inner edge twice and new to the mesh, no vertex left
// over.
bool fits(const EdgeSet& existing, const std::vector<int>& loop,
          const std::vector<std::array<int, 3>>& patch) {
  const int n = static_cast<int>(loop.size());
  if (static_cast<int>(patch.size()) != n - 2) return false;
  std::map<std::pair<int, int>, int> uses;
  for (const auto& t : patch) {
    for (int k = 0; k < 3; ++k) {
      if (++uses[{t[k], t[(k + 1) % 3]}] > 1) return false;
    }
  }
  for (const auto& [edge, count] : uses) {
    const auto [a, b] = edge;
    if ((a + 1) % n == b) continue;
    if (uses.count({b, a}) == 0 || existing.contains(loop[a], loop[b])) return false;
  }
  return true;
}

void fan(TriangleMesh& mesh, const Opening& opening) {
  const int middle = static_cast<int>(mesh.vertices.size());
  mesh.vertices.push_back(opening.middle);
  for (std::size_t i = 0; i < opening.loop.size(); ++i) {
    mesh.triangles.push_back({opening.loop[i], opening.loop[(i + 1) % opening.loop.size()], middle});
  }
}

}  // namespace

std::vector<Opening> find_openings(const TriangleMesh& mesh) {
  const EdgeTable edges(mesh);
  std::vector<int> open;            // boundary half-edges
  std::multimap<int, int> leaving;  // filling sense: from a boundary half-edge's target to its origin
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (edges.half_edges(e).size() == 1) open.push_back(edges.half_edges(e)[0]);
  }
  std::sort(open.begin(), open.end());
  for (const int h : open) leaving.emplace(target_of(mesh, h), origin_of(mesh, h));
  std::vector<Opening> openings;
  std::unordered_map<int, std::size_t> place_in_path;
  for (const int h : open) {
    std::vector<int> path{target_of(mesh, h)};
    place_in_path = {{path[0], 0}};
    for (auto step = leaving.find(path.back()); step != leaving.end(); step = leaving.find(path.back())) {
      const int to = step->second;
      leaving.erase(step);
      const auto [place, is_new] = place_in_path.try_emplace(to, path.size());
      if (is_new) {
        path.push_back(to);
        continue;
      }
      const auto first = path.begin() + static_cast<std::ptrdiff_t>(place->second);
      openings.push_back(make_opening(mesh, {first, path.end()}));
      for (auto passed = first + 1; passed != path.end(); ++passed) place_in_path.erase(*passed);
      path.erase(first + 1, path.end());
    }
  }
  return openings;
}

namespace {

// Twice the area, along the normal of the loop (Newell).
Eigen::Vector3d area_vector(const TriangleMesh& mesh, const Opening& opening) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < opening.loop.size(); ++i) {
    const Eigen::Vector3d p = mesh.vertices[opening.loop[i]] - opening.middle;
    const Eigen::Vector3d q = mesh.vertices[opening.loop[(i + 1) % opening.loop.size()]] - opening.middle;
    sum += p.cross(q);
  }
  return sum;
}

}  // namespace

bool is_flat_cut(const TriangleMesh& mesh, const Opening& opening, double tolerance) {
  const Eigen::Vector3d normal = area_vector(mesh, opening).normalized();
  if (normal.norm() < 0.5) return false;
  const double most = tolerance * opening.length;
  for (const int v : opening.loop) {
    if (std::abs((mesh.vertices[v] - opening.middle).dot(normal)) > most) return false;
  }
  // The cap looks along the normal of the loop in the filling sense: the body lies behind it.
  double highest = 0, lowest = 0;
  for (const Eigen::Vector3d& v : mesh.vertices) {
    const double height = (v - opening.middle).dot(normal);
    highest = std::max(highest, height);
    lowest = std::min(lowest, height);
  }
  return highest <= most && lowest < -2 * most;
}

double opening_area(const TriangleMesh& mesh, const Opening& opening) {
  return area_vector(mesh, opening).norm() / 2;
}

void fill_openings(TriangleMesh& mesh, const std::vector<Opening>& openings) {
  EdgeSet existing(mesh);
  for (const Opening& opening : openings) {
    std::vector<Eigen::Vector3d> points;
    points.reserve(opening.loop.size());
    for (const int v : opening.loop) points.push_back(mesh.vertices[v]);
    const auto patch = triangulate_closed_polyline(points);
    const std::size_t before = mesh.triangles.size();
    if (fits(existing, opening.loop, patch)) {
      for (const auto& [a, b, c] : patch)
        mesh.triangles.push_back({opening.loop[a], opening.loop[b], opening.loop[c]});
    } else {
      fan(mesh, opening);
    }
    for (std::size_t t = before; t < mesh.triangles.size(); ++t) existing.add(mesh.triangles[t]);
  }
}

}  // namespace skinframe
