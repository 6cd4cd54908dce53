// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/export/thin_out.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "worker/export/thin_block.h"
#include "worker/export/triangle_gap.h"

namespace skinframe {
namespace {

// The quadric error allowed in each pass, in deviations: cheap collapses come first everywhere.
constexpr std::array kPasses = {0.15, 0.4, 1.0, 1.0};
// Where nothing is bounded the steps are small and their order matters less: each pass takes what is cheap
// enough, and what it was refused may have room in the next.
constexpr int kUnboundedPasses = 4;
constexpr double kEnough = 1.002;  // of the triangles wanted: no pass is made for less
constexpr double kTrianglesABlock = 6000.0;
constexpr double kBlocksInSurface = 2.0;  // of n^3 boxes about a body, some 2 n^2 hold surface
constexpr int kMostBlocksAcross = 24;
constexpr double kBlockGapMm = 1e-4;  // between what two blocks may write
constexpr double kLargeInDeviations = 4.0;

// Boxes of one width that fill space, numbered within the mesh's box.
class Boxes {
 public:
  Boxes(const TriangleMesh& mesh, std::size_t triangles, int pass) {
    const BoundingBox box = bounding_box(mesh);
    const double across = std::sqrt(static_cast<double>(triangles) / kTrianglesABlock / kBlocksInSurface);
    const int n = std::clamp(static_cast<int>(std::lround(across)), 1, kMostBlocksAcross);
    width_ = 1.01 * box.extent().maxCoeff() / n + 1.0;
    // Seams of one pass lie within boxes of the next: thirds do not meet again for three passes.
    low_ = box.min.array() - 0.005 * width_ - (n > 1 ? width_ * (pass % 3) / 3.0 : 0.0);
    for (int k = 0; k < 3; ++k) counts_[k] = 1 + static_cast<int>((box.max[k] - low_[k]) / width_);
  }

  std::array<int, 3> cell(const Eigen::Vector3d& p) const {
    std::array<int, 3> at{};
    for (int k = 0; k < 3; ++k)
      at[k] = std::clamp(static_cast<int>((p[k] - low_[k]) / width_), 0, counts_[k] - 1);
    return at;
  }
  int number(const std::array<int, 3>& c) const { return (c[0] * counts_[1] + c[1]) * counts_[2] + c[2]; }
  int count() const { return counts_[0] * counts_[1] * counts_[2]; }
  Eigen::AlignedBox3d box(int number) const {
    const Eigen::Vector3d at(number / counts_[2] / counts_[1], number / counts_[2] % counts_[1],
                             number % counts_[2]);
    const Eigen::Vector3d low = low_ + width_ * at;
    return {low.array() + kBlockGapMm, low.array() + width_ - kBlockGapMm};
  }

 private:
  double width_ = 1.0;
  Eigen::Vector3d low_;
  std::array<int, 3> counts_{};
};

std::vector<ThinningBlock> blocks_of(const TriangleMesh& mesh, const Boxes& boxes) {
  struct Cells {
    std::array<int, 3> low, high;
  };
  const auto cells_of = [&](const std::array<int, 3>& t) {
    Cells cells{boxes.cell(mesh.vertices[t[0]]), boxes.cell(mesh.vertices[t[0]])};
    for (int k = 1; k < 3; ++k) {
      const auto c = boxes.cell(mesh.vertices[t[k]]);
      for (int axis = 0; axis < 3; ++axis) {
        cells.low[axis] = std::min(cells.low[axis], c[axis]);
        cells.high[axis] = std::max(cells.high[axis], c[axis]);
      }
    }
    return cells;
  };
  constexpr int kSeveral = -1;
  std::vector<int> home(mesh.triangles.size());  // the box that a triangle is in
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, home.size(), 4096), [&](const auto& range) {
    for (std::size_t t = range.begin(); t < range.end(); ++t) {
      const auto [low, high] = cells_of(mesh.triangles[t]);
      home[t] = low == high ? boxes.number(low) : kSeveral;
    }
  });
  std::vector<ThinningBlock> blocks(boxes.count());
  for (int t = 0; t < static_cast<int>(home.size()); ++t) {
    if (home[t] != kSeveral) {
      blocks[home[t]].own.push_back(t);
      continue;
    }
    const auto [low, high] = cells_of(mesh.triangles[t]);
    for (int x = low[0]; x <= high[0]; ++x)
      for (int y = low[1]; y <= high[1]; ++y)
        for (int z = low[2]; z <= high[2]; ++z) blocks[boxes.number({x, y, z})].beside.push_back(t);
  }
  for (int b = 0; b < boxes.count(); ++b) blocks[b].box = boxes.box(b);
  std::erase_if(blocks, [](const ThinningBlock& b) { return b.own.empty(); });
  return blocks;
}

// Of the triangles within the blocks; those at seams stay. Once few are left to go, blocks make up for the
// seams, so that no further pass is needed for what these held back.
double share_to_keep(const std::vector<ThinningBlock>& blocks, std::size_t left,
                     const ThinningOptions& options, int pass) {
  const auto all = static_cast<double>(left), wanted = static_cast<double>(options.triangles);
  if (options.is_bounded || pass == 0) return wanted / all;
  double own = 0.0;
  for (const ThinningBlock& block : blocks) own += static_cast<double>(block.own.size());
  return std::max(0.0, 1.0 - (all - wanted) / std::max(own, 1.0));
}

// All corners, each bound to one of its triangles, and the middles of large triangles.
std::vector<SurfacePoint> points_of(const TriangleMesh& mesh, double large_mm) {
  std::vector<SurfacePoint> points;
  std::vector<char> done(mesh.vertices.size(), 0);
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const auto &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
    const Eigen::Vector3f normal = (q - p).cross(r - p).stableNormalized().cast<float>();
    for (int v : {a, b, c}) {
      if (!std::exchange(done[v], 1)) points.push_back({mesh.vertices[v].cast<float>(), normal, t});
    }
    if (std::max({(p - q).squaredNorm(), (q - r).squaredNorm(), (r - p).squaredNorm()}) > large_mm * large_mm)
      points.push_back({((p + q + r) / 3.0).cast<float>(), normal, t});
  }
  return points;
}

void link_points(ThinningState& state) {
  state.first_point.assign(state.mesh->triangles.size() + 1, 0);
  for (const auto& p : state.points) ++state.first_point[p.triangle + 1];
  for (std::size_t t = 0; t + 1 < state.first_point.size(); ++t)
    state.first_point[t + 1] += state.first_point[t];
  state.points_of.resize(state.points.size());
  std::vector<int> next(state.first_point.begin(), state.first_point.end() - 1);
  for (int i = 0; i < static_cast<int>(state.points.size()); ++i)
    state.points_of[next[state.points[i].triangle]++] = i;
}

void drop_gone(ThinningState& state) {
  auto& triangles = state.mesh->triangles;
  std::vector<int> place(triangles.size(), -1);
  int used = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    if (state.gone[t]) continue;
    place[t] = used;
    triangles[used++] = triangles[t];
  }
  triangles.resize(used);
  for (auto& p : state.points) p.triangle = place[p.triangle];
}

double furthest_point(const ThinningState& state) {
  const TriangleMesh& mesh = *state.mesh;
  const double squared = tbb::parallel_reduce(
      tbb::blocked_range<std::size_t>(0, state.points.size(), 4096), 0.0,
      [&](const auto& range, double most) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          const auto& [a, b, c] = mesh.triangles[state.points[i].triangle];
          most = std::max(most, squared_distance(state.points[i].place_mm.template cast<double>(),
                                                 {mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]}));
        }
        return most;
      },
      [](double x, double y) { return std::max(x, y); });
  return std::sqrt(squared);
}

}  // namespace

Thinned thin_out(TriangleMesh& mesh, const ThinningOptions& options, const RunContext& context) {
  SKINFRAME_CHECK(options.max_deviation_mm > 0.0);
  if (mesh.triangles.size() <= options.triangles) return {0.0, options.exact_vertices};
  ThinningState state;
  state.mesh = &mesh;
  state.exact_vertices = options.exact_vertices;
  state.exact_stay = options.exact_stay;
  state.original = options.original;
  if (options.is_bounded) state.points = points_of(mesh, kLargeInDeviations * options.max_deviation_mm);
  const int passes = options.is_bounded ? static_cast<int>(kPasses.size()) : kUnboundedPasses;
  const auto enough =
      static_cast<std::size_t>((options.is_bounded ? 1.0 : kEnough) * static_cast<double>(options.triangles));
  for (int pass = 0; pass < passes; ++pass) {
    const std::size_t left = mesh.triangles.size();
    if (left <= enough || context.cancelled()) break;
    const double of_deviation = options.is_bounded ? kPasses[pass] : 1.0;
    const auto blocks = blocks_of(mesh, Boxes(mesh, left, pass));
    const double share = share_to_keep(blocks, left, options, pass);
    state.gone.assign(left, 0);
    link_points(state);
    tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t b) {
      const auto least = static_cast<std::size_t>(share * static_cast<double>(blocks[b].own.size()));
      thin_block(state, blocks[b],
                 {of_deviation * options.max_deviation_mm, options.max_deviation_mm, options.is_bounded,
                  options.is_clear, least});
    });
    drop_gone(state);
  }
  Thinned result{furthest_point(state), 0};
  std::vector<char> used(options.exact_vertices, 0);
  for (const auto& t : mesh.triangles)
    for (int v : t)
      if (v < options.exact_vertices) used[v] = 1;
  result.exact_vertices = static_cast<int>(std::count(used.begin(), used.end(), 1));
  drop_unused_vertices(mesh);
  return result;
}

}  // namespace skinframe
