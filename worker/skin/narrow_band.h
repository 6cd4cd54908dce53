// SPDX-License-Identifier: GPL-3.0-or-later
// The signed distance to a closed mesh in two bands about it. Includes OpenVDB: for .cpp files of this room
// only.
//
// OpenVDB tells the voxels next to the surface and which side of it they are on. From there the bands grow
// outwards and inwards, the nearest voxels first: each is measured to the triangles that are nearest to the
// 26 about it. OpenVDB's own way of growing measures each to all that are nearest to any within five steps,
// which takes several times as long for the same distances.
#pragma once

#include <openvdb/openvdb.h>

#include <vector>

namespace skinframe {

// Distance in mm, negative inside: true within the bands, clamped to them and inactive beyond.
openvdb::FloatGrid::Ptr narrow_band(const std::vector<openvdb::Vec3s>& points_mm,
                                    const std::vector<openvdb::Vec3I>& triangles, double voxel_mm,
                                    double outer_voxels, double inner_voxels);

}  // namespace skinframe
