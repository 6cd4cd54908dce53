// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/skin/distance_field.h"

#include <openvdb/tools/Interpolation.h>

#include <algorithm>

#include "worker/skin/distance_grids.h"

namespace skinframe {
namespace {

double sample(const openvdb::FloatGrid& grid, const Eigen::Vector3d& p) {
  const auto index = grid.transform().worldToIndex(openvdb::Vec3d(p.x(), p.y(), p.z()));
  return openvdb::tools::BoxSampler::sample(grid.tree(), index);
}

// Grid indices are 32-bit: points further out than this would wrap around, and are outside of any body
// anyway.
constexpr double kFarMm = 1e6;

}  // namespace

double DistanceField::at(const Eigen::Vector3d& p) const {
  if (!grids_) return 0.0;
  if (!(p.cwiseAbs().maxCoeff() < kFarMm)) return grids_->outer_band_mm;
  const double fine = sample(*grids_->fine, p);
  // One voxel short of the band's end all eight corners are still true distances.
  if (fine > -grids_->inner_band_mm + 1.5 * grids_->voxel_mm) return std::min(fine, grids_->outer_band_mm);
  return std::min(sample(*grids_->coarse, p), fine);
}

Eigen::Vector3d DistanceField::gradient(const Eigen::Vector3d& p) const {
  if (!grids_) return Eigen::Vector3d::Zero();
  const double h = 0.5 * grids_->voxel_mm;
  Eigen::Vector3d g;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(i);
    g[i] = (at(p + step) - at(p - step)) / (2.0 * h);
  }
  return g;
}

double DistanceField::voxel_mm() const { return grids_ ? grids_->voxel_mm : 0.0; }
double DistanceField::coarse_voxel_mm() const { return grids_ ? grids_->coarse_voxel_mm : 0.0; }
double DistanceField::outer_band_mm() const { return grids_ ? grids_->outer_band_mm : 0.0; }

}  // namespace skinframe
