// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/skin/wall_samples.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace skinframe {
namespace {

constexpr std::size_t kTrianglesABlock = 2048;
constexpr double kLeastStepInVoxels = 0.15;
constexpr double kSurelyOutsideInVoxels = 0.25;

// Where the ray leaves M again, or more than the limit: steps as long as the field knows to be inside. It has
// left once the field says so by more than its error: a ray along a neighbouring face has not.
double length_inside(const DistanceField& field, const Eigen::Vector3d& from, const Eigen::Vector3d& inward,
                     double limit) {
  const double least = kLeastStepInVoxels * field.voxel_mm();
  const double sure = kSurelyOutsideInVoxels * field.voxel_mm();
  double before = 0.0, depth_before = 0.0, left = -1.0;
  double t = 2.0 * least;
  while (t < limit + 2.0 * sure) {
    const double depth = -field.at(from + t * inward);
    if (depth > 0.0) {
      left = -1.0;
    } else if (left < 0.0) {
      const double share = depth_before > 0.0 ? depth_before / (depth_before - depth) : 0.5;
      left = before + share * (t - before);
    }
    if (depth < -sure) return left;
    before = t;
    depth_before = depth;
    t += std::max(depth, least);
  }
  return t;
}

void sample_triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                     const DistanceField& field, double limit, double spacing, std::vector<WallSample>& out) {
  const Eigen::Vector3d twice_area = (b - a).cross(c - a);
  const double area = 0.5 * twice_area.norm();
  if (!(area > 0.0)) return;
  const Eigen::Vector3d inward = -twice_area.normalized();
  const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
  const int n = std::max(1, static_cast<int>(std::ceil(longest / spacing)));
  const Eigen::Vector3d u = (b - a) / n, v = (c - a) / n;
  const auto take = [&](const Eigen::Vector3d& p) {
    const double thickness = length_inside(field, p, inward, limit);
    if (thickness < limit) out.push_back({p + 0.5 * thickness * inward, thickness, area / (n * n)});
  };
  // The n^2 equal small triangles, by their centroids.
  for (int i = 0; i < n; ++i) {
    for (int j = 0; i + j < n; ++j) {
      take(a + (i + 1.0 / 3.0) * u + (j + 1.0 / 3.0) * v);
      if (i + j + 1 < n) take(a + (i + 2.0 / 3.0) * u + (j + 2.0 / 3.0) * v);
    }
  }
}

}  // namespace

std::vector<WallSample> sample_thin_walls(const TriangleMesh& mesh, const DistanceField& field, double limit,
                                          double spacing) {
  const std::size_t blocks = (mesh.triangles.size() + kTrianglesABlock - 1) / kTrianglesABlock;
  std::vector<std::vector<WallSample>> found(blocks);
  tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t block) {
    const std::size_t last = std::min(mesh.triangles.size(), (block + 1) * kTrianglesABlock);
    for (std::size_t t = block * kTrianglesABlock; t < last; ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      sample_triangle(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c], field, limit, spacing,
                      found[block]);
    }
  });
  std::vector<WallSample> samples;
  for (const auto& part : found) samples.insert(samples.end(), part.begin(), part.end());
  return samples;
}

}  // namespace skinframe
