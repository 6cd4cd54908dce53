// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/skin/fine_detail.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "worker/skin/level_set.h"
#include "worker/skin/taubin.h"
#include "worker/skin/triangle_tree.h"

namespace skinframe {
namespace {

constexpr double kBandVoxels = 3.0;
constexpr int kPairs = 30;        // of Taubin's steps at first
constexpr int kRounds = 4;        // of pushing inside; between them
constexpr int kPairsARound = 10;  // fairing again, which takes the kinks from what was pushed

class Inside {
 public:
  Inside(const TriangleMesh& body, const DistanceField& field, double margin)
      : tree_(body), field_(field), margin_(margin) {}

  // The field knows but near the surface.
  bool holds(const Eigen::Vector3d& p) const {
    const double distance = field_.at(p);
    return std::abs(distance) > field_.voxel_mm() ? distance < 0.0 : tree_.is_inside(p);
  }
  // To the margin below the nearest point of M, where p stands higher; whether it did.
  bool push(Eigen::Vector3d& p) const {
    if (field_.at(p) < -(margin_ + field_.voxel_mm())) return false;
    const Eigen::Vector3d foot = tree_.nearest(p), off = p - foot;
    const double distance = off.norm();
    const bool inside = tree_.is_inside(p);
    if (inside && distance >= margin_) return false;
    const Eigen::Vector3d inward = distance > 1e-9 ? Eigen::Vector3d((inside ? off : -off) / distance)
                                                   : Eigen::Vector3d(-field_.gradient(p).normalized());
    p = foot + margin_ * inward;
    return true;
  }

 private:
  TriangleTree tree_;
  const DistanceField& field_;
  double margin_;
};

template <class Visit>
int count_in_parallel(std::size_t size, const Visit& visit) {
  std::atomic<int> count = 0;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, size, 512), [&](const auto& range) {
    int here = 0;
    for (std::size_t i = range.begin(); i < range.end(); ++i) here += visit(i);
    count += here;
  });
  return count;
}

}  // namespace

TriangleMesh fair_surface(const TriangleMesh& closed_mesh, double thickness_mm, double voxel_mm) {
  const double voxel = std::max(kDetailVoxelInThicknesses * thickness_mm, voxel_mm);
  TriangleMesh faired = iso_surface(distance_grid(closed_mesh, voxel, kBandVoxels, kBandVoxels), 0.0);
  fair_taubin(faired, kPairs);
  return faired;
}

FineDetail measure_detail(const TriangleMesh& faired, const DistanceField& field, double thickness_mm) {
  const double height = kDetailHeightInThicknesses * thickness_mm;
  std::vector<double> off(faired.vertices.size());
  tbb::parallel_for(std::size_t{0}, off.size(),
                    [&](std::size_t v) { off[v] = std::abs(field.at(faired.vertices[v])); });
  double area = 0.0, above = 0.0, squares = 0.0;
  for (const auto& t : faired.triangles) {
    const Eigen::Vector3d& a = faired.vertices[t[0]];
    const double third = (faired.vertices[t[1]] - a).cross(faired.vertices[t[2]] - a).norm() / 6.0;
    for (const int v : t) {
      area += third;
      squares += third * off[v] * off[v];
      if (off[v] > height) above += third;
    }
  }
  if (!(area > 0.0)) return {};
  return {above / area, std::sqrt(squares / area)};
}

InnerCopy keep_inside(const TriangleMesh& faired, const TriangleMesh& closed_mesh, const DistanceField& field,
                      double thickness_mm, const RunContext& context) {
  InnerCopy copy{faired, 0, 0};
  const Inside inside(closed_mesh, field, kDetailMarginInThicknesses * thickness_mm);
  auto& corners = copy.mesh.vertices;
  for (int round = 0; round < kRounds && !context.cancelled(); ++round) {
    if (round > 0) fair_taubin(copy.mesh, kPairsARound);
    copy.pushed = count_in_parallel(corners.size(), [&](std::size_t v) { return inside.push(corners[v]); });
  }
  copy.left_outside =
      count_in_parallel(corners.size(), [&](std::size_t v) { return !inside.holds(corners[v]); }) +
      count_in_parallel(copy.mesh.triangles.size(), [&](std::size_t i) {
        const auto& t = copy.mesh.triangles[i];
        return !inside.holds((corners[t[0]] + corners[t[1]] + corners[t[2]]) / 3.0);
      });
  return copy;
}

}  // namespace skinframe
