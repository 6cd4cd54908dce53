// SPDX-License-Identifier: GPL-3.0-or-later
// Capsules by exact intersection with the parallel rays of the view: round at any size, without triangles.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "worker/raster/scene.h"

namespace skinframe {
namespace {

// In the view's axes and mm; rays run along -z.
struct Capsule {
  Eigen::Vector3d a, b, along;  // along: unit vector from a to b, or zero
  double length = 0, radius = 0;
};

struct Hit {
  double depth_mm = -std::numeric_limits<double>::infinity();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
};

// The nearest point of the capsule on the ray through (x, y). It is convex: the nearest of its parts' hits.
Hit nearest(const Capsule& capsule, double x, double y) {
  Hit hit;
  const double r2 = capsule.radius * capsule.radius;
  for (const Eigen::Vector3d* end : {&capsule.a, &capsule.b}) {
    const double dx = x - end->x(), dy = y - end->y(), left = r2 - dx * dx - dy * dy;
    if (left < 0 || end->z() + std::sqrt(left) <= hit.depth_mm) continue;
    hit = {end->z() + std::sqrt(left), Eigen::Vector3d(dx, dy, std::sqrt(left)) / capsule.radius};
  }
  // |q0 + z qe|^2 = r^2, q: the part of (ray - a) perpendicular to the axis.
  const Eigen::Vector3d from_a(x - capsule.a.x(), y - capsule.a.y(), -capsule.a.z());
  const double slope = capsule.along.z(), square = 1 - slope * slope;
  if (square < 1e-12 || capsule.length == 0) return hit;  // seen along its axis: its end hides the rest
  const double axial = from_a.dot(capsule.along);
  const Eigen::Vector3d q0 = from_a - axial * capsule.along;
  const double half = from_a.z() - axial * slope,
               discriminant = half * half - square * (q0.squaredNorm() - r2);
  if (discriminant < 0) return hit;
  const double depth = (-half + std::sqrt(discriminant)) / square, t = axial + depth * slope;
  if (t < 0 || t > capsule.length || depth <= hit.depth_mm) return hit;
  const Eigen::Vector3d q = q0 + depth * (Eigen::Vector3d::UnitZ() - slope * capsule.along);
  return {depth, q / capsule.radius};
}

}  // namespace

void Scene::add_capsule(const Eigen::Vector3d& a_mm, const Eigen::Vector3d& b_mm, double radius_mm,
                        Colour colour) {
  if (!(radius_mm > 0)) return;
  Capsule capsule{camera_.axes * a_mm, camera_.axes * b_mm, Eigen::Vector3d::Zero(), (b_mm - a_mm).norm(),
                  radius_mm};
  if (capsule.length > 0) capsule.along = (capsule.b - capsule.a) / capsule.length;
  const Eigen::Vector3d a = camera_.project(a_mm), b = camera_.project(b_mm);
  const double reach = radius_mm * camera_.px_per_mm + 1;
  const auto row_of = [&](double y) { return std::clamp<double>(std::floor(y), 0, height_); };
  const int top = static_cast<int>(row_of(std::min(a.y(), b.y()) - reach));
  const int bottom = std::min(height_ - 1, static_cast<int>(row_of(std::max(a.y(), b.y()) + reach)));
  for (int y = top; y <= bottom; ++y) {
    // The part of the axis within reach of this row, and as far to its sides.
    double from = 0, to = 1;
    const double rise = b.y() - a.y();
    if (std::abs(rise) > 1e-9) {
      const double t0 = (y + 0.5 - reach - a.y()) / rise, t1 = (y + 0.5 + reach - a.y()) / rise;
      from = std::clamp(std::min(t0, t1), 0.0, 1.0);
      to = std::clamp(std::max(t0, t1), 0.0, 1.0);
    }
    const double x0 = a.x() + from * (b.x() - a.x()), x1 = a.x() + to * (b.x() - a.x());
    const int left = static_cast<int>(std::clamp<double>(std::floor(std::min(x0, x1) - reach), 0, width_));
    const int right = static_cast<int>(std::clamp<double>(std::ceil(std::max(x0, x1) + reach), 0, width_));
    const double up = (camera_.shift_px.y() - y - 0.5) / camera_.px_per_mm;
    for (int x = left; x < right; ++x) {
      const Hit hit = nearest(capsule, (x + 0.5 - camera_.shift_px.x()) / camera_.px_per_mm, up);
      if (hit.depth_mm == -std::numeric_limits<double>::infinity()) continue;
      if (cut_ && hit.depth_mm > cut_depth_mm(x, y)) continue;
      put(std::size_t(y) * std::size_t(width_) + std::size_t(x), hit.depth_mm, hit.normal, colour);
    }
  }
}

}  // namespace skinframe
