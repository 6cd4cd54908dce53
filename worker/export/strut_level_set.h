// SPDX-License-Identifier: GPL-3.0-or-later
// The struts as one level set: the distance to the nearest capsule (axis and radius), negative inside.
// Includes OpenVDB: for .cpp files of this room only.
#pragma once

#include <openvdb/openvdb.h>

#include <vector>

#include "worker/frame/frame.h"

namespace skinframe {

// A narrow band of half_band_mm about the surface, clamped beyond. Each 8^3 leaf of the grid looks only at
// the struts that come near it; the leaves are filled in parallel, each by itself, so the result does not
// depend on the threads.
openvdb::FloatGrid::Ptr strut_level_set(const Frame& frame, const std::vector<double>& radii_mm,
                                        double voxel_mm, double half_band_mm);

}  // namespace skinframe
