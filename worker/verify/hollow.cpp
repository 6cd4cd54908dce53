// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/verify/hollow.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace skinframe {
namespace {

using Eigen::Vector3d;
constexpr double kPoints = 300000;  // in the body's box, one anywhere in each cell of a lattice

}  // namespace

double equal_volume_wall_mm(const Skin& skin, double solid_volume_mm3, double volume_mm3) {
  const Vector3d low = skin.body_box_mm.min, extent = skin.body_box_mm.extent();
  const double spacing = std::cbrt(extent.prod() / kPoints);
  const Eigen::Vector3i cells = (extent / spacing).array().ceil().cast<int>().max(1);
  const Vector3d step = extent.cwiseQuotient(cells.cast<double>());
  // Not the cells' middles: below a flat face these are all as deep as each other.
  std::mt19937 random(1);
  const auto share_of_cell = [&] { return random() * 0x1p-32; };
  std::vector<double> depths;
  for (int z = 0; z < cells.z(); ++z)
    for (int y = 0; y < cells.y(); ++y)
      for (int x = 0; x < cells.x(); ++x) {
        const Vector3d at{x + share_of_cell(), y + share_of_cell(), z + share_of_cell()};
        const double depth = -skin.field.at(low + step.cwiseProduct(at));
        if (depth > 0) depths.push_back(depth);
      }
  if (depths.empty()) return skin.thickness_mm;
  const double share = std::clamp(volume_mm3 / solid_volume_mm3, 0.0, 1.0);
  const auto at = std::min(depths.size() - 1, static_cast<std::size_t>(share * depths.size()));
  std::nth_element(depths.begin(), depths.begin() + at, depths.end());
  return depths[at];
}

std::vector<double> local_walls_mm(const FineSkin& fine, const Skin& skin, const TriangleTree& body,
                                   double wall_mm) {
  std::vector<double> walls;
  for (std::size_t i = 0; i < fine.normals.size(); ++i) {
    const double most = 2 * wall_mm + skin.thickness_mm;
    const double through = body.way_out(fine.frame.nodes_mm[i], -fine.normals[i], most) + skin.thickness_mm;
    walls.push_back(std::min(wall_mm, through / 2));
  }
  return walls;
}

}  // namespace skinframe
