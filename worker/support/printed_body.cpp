// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/support/printed_body.h"

#include <algorithm>
#include <cmath>

#include "worker/skin/build_skin.h"

namespace skinframe {
namespace {
constexpr double kUniqueNormal = 0.7;      // length of the gradient below which the nearest wall is not one
constexpr double kWallReachInSkins = 1.5;  // a point deeper than this is in no wall
constexpr double kFootInSkins = 0.5;       // feet stand that deep in the floor
}  // namespace

PrintedBody body_of(const Skin& skin) {
  return {[&skin](const Eigen::Vector3d& p) { return -skin.field.at(p); },
          [&skin](const Eigen::Vector3d& p) { return skin.field.gradient(p); }, skin.thickness_mm,
          skin.plate_z_mm, skin.voxel_mm};
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
  if (std::abs(body.depth_mm(point)) > kWallReachInSkins * body.skin_thickness_mm) return false;
  const Eigen::Vector3d out = body.outward(point);
  const double length = out.norm();
  return length >= kUniqueNormal && std::abs(out.z()) <= std::sin(angle_rad) * length;
}

}  // namespace skinframe
