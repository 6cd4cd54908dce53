// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/skin/thin_parts.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <unordered_map>

#include "worker/skin/triangle_tree.h"
#include "worker/skin/wall_samples.h"

namespace skinframe {
namespace {

constexpr double kSampleSpacingInThicknesses = 0.5;
constexpr double kMostSamples = 2e6;
constexpr double kFieldErrorInVoxels = 0.5;  // walls that much above the limit are looked at too
constexpr double kLatticeInThicknesses = 0.25;
constexpr std::size_t kMostCells = 300'000;
constexpr double kSheetOrLimb = 1.5;

using Cell = Eigen::Vector3i;

std::uint64_t key_of(const Cell& c) {  // 21 bits an axis: a million cells either way of the origin
  constexpr int kBias = 1 << 20;
  constexpr std::uint64_t kMask = (1u << 21) - 1;
  const auto bits = [](int x) { return static_cast<std::uint64_t>(x + kBias) & kMask; };
  return bits(c.x()) << 42 | bits(c.y()) << 21 | bits(c.z());
}

Cell cell_of(const Eigen::Vector3d& p, double width) { return (p / width).array().floor().cast<int>(); }

// The cells of that width that a thin point may stand in: within half of the limit of a wall's middle, in
// order.
std::vector<Cell> cells_near(const std::vector<WallSample>& walls, double width, double half_limit) {
  std::unordered_map<std::uint64_t, Cell> middles, found;
  for (const WallSample& w : walls)
    middles.try_emplace(key_of(cell_of(w.middle_mm, width)), cell_of(w.middle_mm, width));
  const int reach = static_cast<int>(std::ceil(half_limit / width));
  for (const auto& [key, middle] : middles) {
    for (int x = -reach; x <= reach; ++x) {
      for (int y = -reach; y <= reach; ++y) {
        for (int z = -reach; z <= reach; ++z) {
          const Cell c = middle + Cell(x, y, z);
          if (x * x + y * y + z * z <= (reach + 1) * (reach + 1)) found.try_emplace(key_of(c), c);
        }
      }
    }
  }
  std::vector<std::pair<std::uint64_t, Cell>> ordered(found.begin(), found.end());
  std::sort(ordered.begin(), ordered.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Cell> cells;
  cells.reserve(ordered.size());
  for (const auto& [key, c] : ordered) cells.push_back(c);
  return cells;
}

// One point in each cell, by chance, so that walls along the lattice are measured as well as any others.
Eigen::Vector3d point_in(const Cell& c, double width) {
  std::minstd_rand random(static_cast<std::uint32_t>(key_of(c) * 0x9E3779B97F4A7C15ull >> 33) + 1u);
  random.discard(2);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const double x = unit(random), y = unit(random), z = unit(random);
  return width * (c.cast<double>() + Eigen::Vector3d(x, y, z));
}

bool is_thin(const TriangleTree& tree, const Eigen::Vector3d& p, double limit) {
  const Eigen::Vector3d from_foot = p - tree.nearest(p);
  const double depth = from_foot.norm();
  if (depth >= 0.5 * limit || depth == 0.0 || !tree.is_inside(p)) return false;
  return depth + tree.way_out(p, from_foot / depth, limit - depth) < limit;
}

int root_of(std::vector<int>& parent, int i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

using CellIndex = std::unordered_map<std::uint64_t, int>;

// The connected piece of each cell, corners included, as the index of its first cell.
std::vector<int> pieces_of(const std::vector<Cell>& cells, const CellIndex& index) {
  std::vector<int> parent(cells.size());
  std::iota(parent.begin(), parent.end(), 0);
  for (int i = 0; i < static_cast<int>(cells.size()); ++i) {
    for (int n = 0; n < 13; ++n) {  // half of the 26 neighbours: the other half finds back
      const auto it = index.find(key_of(cells[i] + Cell(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1)));
      if (it == index.end()) continue;
      const int a = root_of(parent, i), b = root_of(parent, it->second);
      parent[std::max(a, b)] = std::min(a, b);
    }
  }
  for (int i = 0; i < static_cast<int>(cells.size()); ++i) parent[i] = root_of(parent, i);
  return parent;
}

struct Piece {
  int cells = 0;
  double area = 0.0, area_thickness = 0.0;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
};

ThinRegion region_of(const Piece& piece, double cell_volume) {
  ThinRegion region;
  region.volume_mm3 = piece.cells * cell_volume;
  region.centre_mm = piece.sum / piece.cells;
  region.kind =
      piece.area_thickness < kSheetOrLimb * 2.0 * region.volume_mm3 ? ThinKind::kSheet : ThinKind::kLimb;
  if (piece.area > 0.0) region.mean_thickness_mm = piece.area_thickness / piece.area;
  return region;
}

}  // namespace

ThinParts find_thin_parts(const TriangleMesh& mesh, const DistanceField& field, double thickness,
                          const RunContext& context) {
  ThinParts result;
  const double limit = 2.0 * thickness, solid = signed_volume(mesh);
  const double spacing =
      std::max(kSampleSpacingInThicknesses * thickness, std::sqrt(surface_area(mesh) / kMostSamples));
  const auto walls = sample_thin_walls(mesh, field, limit + kFieldErrorInVoxels * field.voxel_mm(), spacing);
  if (walls.empty() || context.cancelled()) return result;

  double width = kLatticeInThicknesses * thickness;
  auto candidates = cells_near(walls, width, thickness);
  while (candidates.size() > kMostCells) {
    width *= 1.05 * std::cbrt(static_cast<double>(candidates.size()) / kMostCells);
    candidates = cells_near(walls, width, thickness);
  }
  const TriangleTree tree(mesh);
  std::vector<char> thin(candidates.size(), 0);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, candidates.size(), 512), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end() && !context.cancelled(); ++i)
      thin[i] = is_thin(tree, point_in(candidates[i], width), limit);
  });
  std::vector<Cell> cells;
  CellIndex index;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (!thin[i]) continue;
    index.emplace(key_of(candidates[i]), static_cast<int>(cells.size()));
    cells.push_back(candidates[i]);
  }

  const auto piece_of = pieces_of(cells, index);
  std::unordered_map<int, Piece> pieces;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    Piece& piece = pieces[piece_of[i]];
    ++piece.cells;
    piece.sum += width * (cells[i].cast<double>().array() + 0.5).matrix();
  }
  for (const WallSample& w : walls) {
    const auto it = index.find(key_of(cell_of(w.middle_mm, width)));
    if (it == index.end()) continue;
    Piece& piece = pieces[piece_of[it->second]];
    piece.area += w.area_mm2;
    piece.area_thickness += w.area_mm2 * w.thickness_mm;
  }
  std::vector<std::pair<int, Piece>> ordered(pieces.begin(), pieces.end());
  std::sort(ordered.begin(), ordered.end(), [](const auto& a, const auto& b) {
    return a.second.cells != b.second.cells ? a.second.cells > b.second.cells : a.first < b.first;
  });
  const double cell_volume = width * width * width;
  for (const auto& [first, piece] : ordered) {
    const ThinRegion region = region_of(piece, cell_volume);
    if (region.volume_mm3 < std::pow(thickness, 3) || result.regions.size() == kMostThinRegions) break;
    result.regions.push_back(region);
  }
  result.region_count = static_cast<int>(ordered.size());
  result.volume_mm3 = std::min(static_cast<double>(cells.size()) * cell_volume, solid);
  result.fraction = result.volume_mm3 / solid;
  return result;
}

}  // namespace skinframe
