// SPDX-License-Identifier: GPL-3.0-or-later
// What stands behind a DistanceField. Includes OpenVDB: for .cpp files of skin and export only.
#pragma once

#include <openvdb/openvdb.h>

namespace skinframe {

struct DistanceGrids {
  openvdb::FloatGrid::ConstPtr fine;    // -inner_band_mm .. +outer_band_mm about M, clamped beyond
  openvdb::FloatGrid::ConstPtr coarse;  // the whole inside
  double voxel_mm = 0.0;
  double coarse_voxel_mm = 0.0;
  double inner_band_mm = 0.0;
  double outer_band_mm = 0.0;
};

}  // namespace skinframe
