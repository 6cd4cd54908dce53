// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/export/keep_wall.h"

#include <tbb/parallel_for.h>

#include <atomic>

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

}  // namespace skinframe
