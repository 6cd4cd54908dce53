// SPDX-License-Identifier: GPL-3.0-or-later
// The signed distance to the input surface M, in mm: negative inside, positive outside.
//
// Two grids stand behind it: a fine narrow band about the surface (deep enough to hold M1, the offset at h_S)
// and a coarse one that fills the whole body. A point is answered by the fine grid where that knows it and by
// the coarse one elsewhere, trilinearly in both.
//
// Guarantees:
//  1. Inside M the value is the distance everywhere: to about 0.05 voxel_mm in the fine band, to about
//     0.1 coarse_voxel_mm deeper; on the medial axis, where it has a ridge, up to half a voxel too shallow.
//  2. Outside M it is the distance up to outer_band_mm() and exactly +outer_band_mm() beyond.
//  3. A default-made field is outside everywhere (at() = 0 with no band).
//  4. Copies share one immutable state; reads from many threads at once are safe.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <utility>

namespace skinframe {

struct DistanceGrids;  // worker/skin/distance_grids.h: OpenVDB's types, for .cpp files of skin and export
                       // only

class DistanceField {
 public:
  DistanceField() = default;
  explicit DistanceField(std::shared_ptr<const DistanceGrids> grids) : grids_(std::move(grids)) {}

  double at(const Eigen::Vector3d& point_mm) const;
  // Central differences of at() over one voxel: about the unit vector away from the nearest surface point,
  // shorter on the medial axis, zero beyond the outer band.
  Eigen::Vector3d gradient(const Eigen::Vector3d& point_mm) const;

  double voxel_mm() const;
  double coarse_voxel_mm() const;
  double outer_band_mm() const;
  const DistanceGrids* grids() const { return grids_.get(); }

 private:
  std::shared_ptr<const DistanceGrids> grids_;
};

}  // namespace skinframe
