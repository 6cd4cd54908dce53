// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/raster/camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace skinframe {

Eigen::Matrix3d view_axes(double azimuth_deg, double elevation_deg) {
  const double a = azimuth_deg * std::numbers::pi / 180, e = elevation_deg * std::numbers::pi / 180;
  const Eigen::Vector3d towards(std::cos(e) * std::sin(a), -std::cos(e) * std::cos(a), std::sin(e));
  const Eigen::Vector3d right(std::cos(a), std::sin(a), 0);
  Eigen::Matrix3d axes;
  axes.row(0) = right;
  axes.row(1) = towards.cross(right);
  axes.row(2) = towards;
  return axes;
}

Camera fit_camera(const Eigen::Matrix3d& axes, const std::vector<Eigen::Vector3d>& points_mm,
                  double margin_mm, double width_px, double height_px) {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Eigen::Vector3d& p : points_mm) {
    const Eigen::Vector2d seen = (axes * p).head<2>();
    low = low.cwiseMin(seen);
    high = high.cwiseMax(seen);
  }
  Camera camera;
  camera.axes = axes;
  if (points_mm.empty()) low = high = Eigen::Vector2d::Zero();
  const Eigen::Vector2d extent = (high - low).array() + 2 * margin_mm, middle = (low + high) / 2;
  const double scale = std::min(width_px / extent.x(), height_px / extent.y());
  if (std::isfinite(scale) && scale > 0) camera.px_per_mm = scale;
  camera.shift_px = {width_px / 2 - camera.px_per_mm * middle.x(),
                     height_px / 2 + camera.px_per_mm * middle.y()};
  return camera;
}

}  // namespace skinframe
