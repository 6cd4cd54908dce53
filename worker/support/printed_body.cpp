// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/support/printed_body.h"

#include <algorithm>
#include <cmath>

#include "worker/skin/build_skin.h"
#include "worker/skin/triangle_tree.h"

namespace skinframe {
namespace {
constexpr double kUniqueNormal = 0.7;      // length of the gradient below which the nearest wall is not one
constexpr double kWallReachInSkins = 1.5;  // a point deeper than this is in no wall
constexpr double kTooNearInSkins = 0.05;   // nearer to the surface the way to it has no direction
constexpr double kFootInSkins = 0.5;       // feet stand that deep in the floor
}  // namespace

PrintedBody body_of(const Skin& skin) {
  return {[&skin](const Eigen::Vector3d& p) { return -skin.field.at(p); },
          [&skin](const Eigen::Vector3d& p) { return skin.field.gradient(p); },
          skin.thickness_mm,
          skin.plate_z_mm,
          skin.voxel_mm,
          {}};
}

PrintedBody body_of(const Skin& skin, const TriangleTree& surface) {
  PrintedBody body = body_of(skin);
  body.to_surface_mm = [&surface](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    return surface.nearest(p) - p;
  };
  return body;
}

std::optional<Footing> footing_below(const PrintedBody& body, const Eigen::Vector3d& point) {
  const double h = body.skin_thickness_mm;
  enum class Now { kMaterial, kCavity, kAir } now = Now::kMaterial;
  Eigen::Vector3d at = point;
  for (double s = body.step_mm;; s += body.step_mm) {
    at.z() = point.z() - s;
    if (at.z() <= body.plate_z_mm) {
      if (now == Now::kMaterial) return std::nullopt;
      at.z() = body.plate_z_mm;
      return Footing{at, now == Now::kAir ? SupportKind::kExternal : SupportKind::kInternal, true};
    }
    const double depth = body.depth_mm(at);
    switch (now) {
      case Now::kMaterial:
        if (depth > 1.1 * h) now = Now::kCavity;
        if (depth < -0.1 * h) now = Now::kAir;
        if (now == Now::kMaterial && s > kSolidBelowInSkins * h) return std::nullopt;
        break;
      case Now::kCavity:
        if (depth <= (1.0 - kFootInSkins) * h) return Footing{at, SupportKind::kInternal, false};
        break;
      case Now::kAir:
        if (depth >= 0.0) return Footing{at, SupportKind::kExternal, false};
        break;
    }
  }
}

std::optional<SupportKind> side_of_segment(const PrintedBody& body, const Eigen::Vector3d& upper,
                                           const Eigen::Vector3d& lower) {
  const double length = (lower - upper).norm(), end = kEndInSkins * body.skin_thickness_mm;
  bool within = false, without = false;
  const auto look = [&](double s) {
    (body.depth_mm(upper + s / length * (lower - upper)) > 0.0 ? within : without) = true;
  };
  if (length <= 2 * end) {
    look(0.5 * length);
  } else {
    const int steps = static_cast<int>(std::ceil((length - 2 * end) / body.step_mm));
    for (int i = 0; i <= steps && !(within && without); ++i) look(end + (length - 2 * end) * i / steps);
  }
  if (within && without) return std::nullopt;
  return within ? SupportKind::kInternal : SupportKind::kExternal;
}

bool is_in_steep_wall(const PrintedBody& body, const Eigen::Vector3d& point, double angle_rad) {
  const double depth = body.depth_mm(point), h = body.skin_thickness_mm;
  if (depth < 0.0) return false;
  Eigen::Vector3d way = Eigen::Vector3d::Zero();
  if (body.to_surface_mm) way = body.to_surface_mm(point);
  if (way.norm() <= kTooNearInSkins * h) {
    const Eigen::Vector3d out = body.outward(point);
    if (out.norm() < kUniqueNormal) return false;
    way = std::max(depth, kTooNearInSkins * h) * out.normalized();
  }
  return way.norm() <= kWallReachInSkins * h && std::abs(way.z()) <= std::sin(angle_rad) * way.norm();
}

}  // namespace skinframe
