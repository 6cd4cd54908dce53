// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/export/strut_level_set.h"

#include <openvdb/tools/SignedFloodFill.h>
#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace skinframe {
namespace {

using Leaf = openvdb::FloatGrid::TreeType::LeafNodeType;
using LeafKey = std::array<int, 3>;
constexpr int kLeafVoxels = Leaf::DIM;

struct Capsule {
  Eigen::Vector3d a, axis;
  double inverse_length_squared, radius;

  double distance(const Eigen::Vector3d& p) const {
    const Eigen::Vector3d to = p - a;
    const double s = std::clamp(to.dot(axis) * inverse_length_squared, 0.0, 1.0);
    return (to - s * axis).norm() - radius;
  }
};

std::vector<Capsule> capsules_of(const Frame& frame, const std::vector<double>& radii_mm) {
  std::vector<Capsule> capsules;
  for (std::size_t j = 0; j < frame.struts.size(); ++j) {
    const Eigen::Vector3d a = frame.nodes_mm[frame.struts[j].a], axis = frame.nodes_mm[frame.struts[j].b] - a;
    const double l2 = axis.squaredNorm();
    capsules.push_back({a, axis, l2 > 0.0 ? 1.0 / l2 : 0.0, radii_mm[j]});
  }
  return capsules;
}

// The leaves that a capsule's band may touch, in order.
std::map<LeafKey, std::vector<int>> capsules_by_leaf(const std::vector<Capsule>& capsules, double voxel,
                                                     double band) {
  std::map<LeafKey, std::vector<int>> leaves;
  const double width = kLeafVoxels * voxel, half_diagonal = 0.5 * std::sqrt(3.0) * width;
  for (int j = 0; j < static_cast<int>(capsules.size()); ++j) {
    const Capsule& c = capsules[j];
    const Eigen::Vector3d b = c.a + c.axis;
    const double reach = c.radius + band;
    const Eigen::Vector3i low = ((c.a.cwiseMin(b).array() - reach) / width).floor().cast<int>();
    const Eigen::Vector3i high = ((c.a.cwiseMax(b).array() + reach) / width).floor().cast<int>();
    for (int x = low.x(); x <= high.x(); ++x) {
      for (int y = low.y(); y <= high.y(); ++y) {
        for (int z = low.z(); z <= high.z(); ++z) {
          const Eigen::Vector3d centre = width * (Eigen::Vector3d(x, y, z).array() + 0.5) - 0.5 * voxel;
          if (c.distance(centre) <= band + half_diagonal) leaves[{x, y, z}].push_back(j);
        }
      }
    }
  }
  return leaves;
}

}  // namespace

openvdb::FloatGrid::Ptr strut_level_set(const Frame& frame, const std::vector<double>& radii_mm,
                                        double voxel_mm, double half_band_mm) {
  openvdb::initialize();
  const auto capsules = capsules_of(frame, radii_mm);
  const auto by_leaf = capsules_by_leaf(capsules, voxel_mm, half_band_mm);
  std::vector<std::pair<const LeafKey*, const std::vector<int>*>> work;
  for (const auto& [key, list] : by_leaf) work.emplace_back(&key, &list);

  std::vector<std::unique_ptr<Leaf>> leaves(work.size());
  tbb::parallel_for(std::size_t{0}, work.size(), [&](std::size_t i) {
    const LeafKey& key = *work[i].first;
    const openvdb::Coord origin(key[0] * kLeafVoxels, key[1] * kLeafVoxels, key[2] * kLeafVoxels);
    auto leaf = std::make_unique<Leaf>(origin, static_cast<float>(half_band_mm), false);
    for (openvdb::Index n = 0; n < Leaf::SIZE; ++n) {
      const openvdb::Coord at = leaf->offsetToGlobalCoord(n);
      const Eigen::Vector3d p = voxel_mm * Eigen::Vector3d(at.x(), at.y(), at.z());
      double d = half_band_mm;
      for (int j : *work[i].second) d = std::min(d, capsules[j].distance(p));
      if (d >= half_band_mm) continue;
      if (d > -half_band_mm)
        leaf->setValueOn(n, static_cast<float>(d));
      else
        leaf->setValueOff(n, static_cast<float>(-half_band_mm));
    }
    leaves[i] = std::move(leaf);
  });

  auto grid = openvdb::FloatGrid::create(static_cast<float>(half_band_mm));
  grid->setTransform(openvdb::math::Transform::createLinearTransform(voxel_mm));
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  for (auto& leaf : leaves) grid->tree().addLeaf(leaf.release());
  openvdb::tools::signedFloodFill(grid->tree());
  return grid;
}

}  // namespace skinframe
