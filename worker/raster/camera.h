// SPDX-License-Identifier: GPL-3.0-or-later
// An orthographic view: parallel lines stay parallel, and a millimetre is as many pixels everywhere.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "worker/mesh/triangle_mesh.h"

namespace skinframe {

struct Camera {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  // rows: right, up, towards the viewer; orthonormal
  double px_per_mm = 1;
  Eigen::Vector2d shift_px = Eigen::Vector2d::Zero();

  // x to the right and y down in px, z towards the viewer in mm.
  Eigen::Vector3d project(const Eigen::Vector3d& point_mm) const {
    const Eigen::Vector3d seen = axes * point_mm;
    return {shift_px.x() + px_per_mm * seen.x(), shift_px.y() - px_per_mm * seen.y(), seen.z()};
  }
  Camera scaled(double factor) const { return {axes, px_per_mm * factor, shift_px * factor}; }
};

// From azimuth (degrees about z; 0: from -y, as a person stands before a machine, 90: from +x) and elevation
// (degrees above the plate).
Eigen::Matrix3d view_axes(double azimuth_deg, double elevation_deg);

// The largest scale at which all points, widened by margin_mm, lie in [0, width] x [0, height]; in its
// middle. Without extent the scale is 1.
Camera fit_camera(const Eigen::Matrix3d& axes, const std::vector<Eigen::Vector3d>& points_mm,
                  double margin_mm, double width_px, double height_px);

}  // namespace skinframe
