// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/solid/weld.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <unordered_map>

#include "worker/solid/half_edges.h"

namespace skinframe {
namespace {

using Cell = std::array<std::int64_t, 3>;

struct CellHash {
  std::size_t operator()(const Cell& cell) const {
    std::uint64_t hash = 0x9E3779B97F4A7C15u;
    for (const std::int64_t c : cell) {
      hash = (hash ^ static_cast<std::uint64_t>(c)) * 0xFF51AFD7ED558CCDu;
      hash ^= hash >> 32;
    }
    return hash;
  }
};

// Cells of twice the tolerance: what is within it lies in the cells that its box touches, mostly one.
class PointGrid {
 public:
  PointGrid(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& origin, double tolerance)
      : points_(points), origin_(origin), tolerance_(tolerance) {}

  // The first point entered that is within the tolerance of point `i`, which is entered if there is none.
  int find_or_add(int i) {
    const Cell low = cell_of(points_[i] - Eigen::Vector3d::Constant(tolerance_));
    const Cell high = cell_of(points_[i] + Eigen::Vector3d::Constant(tolerance_));
    int found = i;
    for (auto x = low[0]; x <= high[0]; ++x) {
      for (auto y = low[1]; y <= high[1]; ++y) {
        for (auto z = low[2]; z <= high[2]; ++z) found = std::min(found, first_near(i, {x, y, z}));
      }
    }
    if (found == i) cells_[cell_of(points_[i])].push_back(i);
    return found;
  }

 private:
  Cell cell_of(const Eigen::Vector3d& p) const {
    Cell cell{};
    for (int k = 0; k < 3; ++k) {
      const double offset = p[k] - origin_[k];
      // Exact joining needs no neighbourhood: equal bits, equal cell.
      cell[k] = tolerance_ > 0 ? static_cast<std::int64_t>(std::floor(offset / (2 * tolerance_)))
                               : std::bit_cast<std::int64_t>(offset + 0.0);
    }
    return cell;
  }
  int first_near(int i, const Cell& cell) const {
    const auto place = cells_.find(cell);
    if (place == cells_.end()) return i;
    for (const int other : place->second) {
      if ((points_[other] - points_[i]).squaredNorm() <= tolerance_ * tolerance_) return other;
    }
    return i;
  }

  const std::vector<Eigen::Vector3d>& points_;
  Eigen::Vector3d origin_;
  double tolerance_;
  std::unordered_map<Cell, std::vector<int>, CellHash> cells_;
};

std::array<int, 3> sorted(std::array<int, 3> triangle) {
  std::sort(triangle.begin(), triangle.end());
  return triangle;
}

void keep(TriangleMesh& mesh, const std::vector<char>& kept) {
  std::size_t next = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (kept[t]) mesh.triangles[next++] = mesh.triangles[t];
  }
  mesh.triangles.resize(next);
}

}  // namespace

std::size_t weld(TriangleMesh& mesh, double tolerance) {
  PointGrid grid(mesh.vertices, bounding_box(mesh).min, tolerance);
  std::vector<int> representative(mesh.vertices.size());
  std::size_t joined = 0;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    representative[v] = grid.find_or_add(static_cast<int>(v));
    joined += representative[v] != static_cast<int>(v);
  }
  for (auto& triangle : mesh.triangles) {
    for (int& v : triangle) v = representative[v];
  }
  drop_unused_vertices(mesh);
  return joined;
}

std::size_t drop_degenerate(TriangleMesh& mesh) {
  return std::erase_if(mesh.triangles, [](const std::array<int, 3>& t) {
    return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
  });
}

DuplicateCounts drop_duplicates(TriangleMesh& mesh) {
  DuplicateCounts counts;
  std::vector<int> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    const auto ta = sorted(mesh.triangles[a]), tb = sorted(mesh.triangles[b]);
    return ta != tb ? ta < tb : a < b;
  });
  std::vector<char> kept(mesh.triangles.size(), 1);
  std::vector<char> doubled(mesh.triangles.size(), 0);
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (sorted(mesh.triangles[order[i]]) != sorted(mesh.triangles[order[i - 1]])) continue;
    kept[order[i]] = 0;
    ++counts.repeated;
    std::size_t first = i - 1;
    while (!kept[order[first]]) --first;
    doubled[order[first]] = 1;
  }
  if (counts.repeated == 0) return counts;

  std::vector<char> still_doubled;
  for (std::size_t t = 0; t < kept.size(); ++t) {
    if (kept[t]) still_doubled.push_back(doubled[t]);
  }
  keep(mesh, kept);
  const EdgeTable edges(mesh);
  kept.assign(mesh.triangles.size(), 1);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto half_edges = edges.half_edges(e);
    if (half_edges.size() <= 2) continue;
    for (const int h : half_edges) {
      if (still_doubled[triangle_of(h)]) kept[triangle_of(h)] = 0;
    }
  }
  counts.walls = static_cast<std::size_t>(std::count(kept.begin(), kept.end(), 0));
  counts.repeated -= std::min(counts.repeated, counts.walls);
  keep(mesh, kept);
  return counts;
}

}  // namespace skinframe
