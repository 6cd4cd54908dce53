// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/export/fill_slivers.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace skinframe {
namespace {

constexpr double kKeptInVoxels = 0.5;
constexpr double kDeepestInVoxels = 1.5;  // below it no node comes near to closing

struct Neighbour {
  openvdb::Coord step;
  float way;  // mm
};

// The six across a face first: beside most walls one of them ends the search.
std::vector<Neighbour> neighbours(double voxel_mm) {
  std::vector<Neighbour> all;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z)
        if (x != 0 || y != 0 || z != 0)
          all.push_back(
              {{x, y, z},
               static_cast<float>(voxel_mm * std::sqrt(static_cast<double>(x * x + y * y + z * z)))});
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.way < b.way; });
  return all;
}

}  // namespace

void fill_slivers(openvdb::FloatGrid& cavity) {
  using Leaf = openvdb::FloatGrid::TreeType::LeafNodeType;
  const double voxel_mm = cavity.voxelSize().x();
  const auto kept = static_cast<float>(kKeptInVoxels * voxel_mm);
  const auto deepest = static_cast<float>(-kDeepestInVoxels * voxel_mm);
  const auto around = neighbours(voxel_mm);
  std::vector<Leaf*> leaves;
  cavity.tree().getNodes(leaves);
  std::vector<std::vector<std::pair<openvdb::Index, float>>> changes(leaves.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, leaves.size(), 64), [&](const auto& range) {
    const auto at = cavity.getConstAccessor();
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      for (auto it = leaves[i]->cbeginValueOn(); it; ++it) {
        const float here = *it;
        if (here >= 0.0f || here < deepest) continue;
        const openvdb::Coord place = it.getCoord();
        float closed = std::numeric_limits<float>::infinity();
        for (const Neighbour& to : around) {
          closed = std::min(closed, at.getValue(place + to.step) + to.way - kept);
          if (closed <= here) break;
        }
        if (closed > here) changes[i].emplace_back(it.pos(), closed);
      }
    }
  });
  tbb::parallel_for(std::size_t{0}, leaves.size(), [&](std::size_t i) {
    for (const auto& [n, value] : changes[i]) leaves[i]->setValueOnly(n, value);
  });
}

}  // namespace skinframe
