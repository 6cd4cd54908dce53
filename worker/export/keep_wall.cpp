// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/export/keep_wall.h"

#include <tbb/parallel_for.h>

#include <atomic>
#include <numeric>
#include <vector>

#include "worker/export/crossings.h"

namespace skinframe {

bool keep_wall(Eigen::Vector3d& vertex, const TriangleTree& body, double least_mm, double to_mm) {
  const Eigen::Vector3d foot = body.nearest(vertex);
  const double depth = (vertex - foot).norm();
  if (depth >= least_mm || depth == 0) return false;
  const Eigen::Vector3d there = foot + (vertex - foot) * (to_mm / depth);
  vertex = there.cast<float>().cast<double>();
  return true;
}

int keep_wall(TriangleMesh& cavity, const TriangleTree& body, const Skin& skin, double voxel_mm) {
  std::atomic<int> moved = 0;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, cavity.vertices.size(), 1024), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      // The field is never too shallow by more than its voxel: what it sees deeper is a strut's, not the
      // wall's.
      if (-skin.field.at(cavity.vertices[i]) > skin.thickness_mm + voxel_mm) continue;
      moved += keep_wall(cavity.vertices[i], body, skin.thickness_mm - kWallSlackInVoxels * voxel_mm,
                         skin.thickness_mm);
    }
  });
  return moved;
}

int count_cuts_of_surface(const TriangleMesh& printable, std::size_t outer, const Skin& skin) {
  constexpr double kNearInSkins = 0.7;  // half the wall and a triangle's reach
  const std::size_t count = printable.triangles.size();
  std::vector<char> near(count, 0);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(outer, count, 4096), [&](const auto& range) {
    for (std::size_t t = range.begin(); t < range.end(); ++t) {
      const auto& [a, b, c] = printable.triangles[t];
      const Eigen::Vector3d middle =
          (printable.vertices[a] + printable.vertices[b] + printable.vertices[c]) / 3.0;
      near[t] = -skin.field.at(middle) < kNearInSkins * skin.thickness_mm;
    }
  });
  std::vector<int> among(outer);
  std::iota(among.begin(), among.end(), 0);
  for (std::size_t t = outer; t < count; ++t)
    if (near[t]) among.push_back(static_cast<int>(t));
  if (among.size() == outer) return 0;
  int cuts = 0;
  for (const auto& [s, t] : crossing_triangles(printable, among))
    cuts += static_cast<std::size_t>(s) < outer && static_cast<std::size_t>(t) >= outer;
  return cuts;
}

}  // namespace skinframe
