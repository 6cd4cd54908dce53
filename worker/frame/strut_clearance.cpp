// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <limits>

#include "worker/frame/convex_region.h"
#include "worker/run/result.h"

namespace skinframe {
namespace {

constexpr double kLeavingSlope = 0.2;  // of the axis against M1 at a skin end
constexpr double kToleranceInVoxels = 1.0 / 3.0;

// Calls visit(depth, t): depth of the axis below the surface that the strut is held to, and the distance t
// from the nearest skin end, infinite where no end counts as one.
template <class Visit>
void walk_axis(const Frame& frame, const Strut& strut, const Skin& skin, Visit visit) {
  const Eigen::Vector3d &a = frame.nodes_mm[strut.a], &b = frame.nodes_mm[strut.b];
  const bool skin_a = strut.a < frame.skin_node_count, skin_b = strut.b < frame.skin_node_count;
  const bool joins_pieces = skin_a && skin_b;
  const double length = (b - a).norm(), surface = joins_pieces ? 0.0 : skin.thickness_mm;
  const int steps = std::max(8, static_cast<int>(std::ceil(length / skin.voxel_mm)));
  for (int i = 0; i <= steps; ++i) {
    const double s = static_cast<double>(i) / steps;
    double t = std::numeric_limits<double>::infinity();
    if (!joins_pieces && skin_a) t = std::min(t, s * length);
    if (!joins_pieces && skin_b) t = std::min(t, (1.0 - s) * length);
    visit(-skin.field.at(a + s * (b - a)) - surface, t);
  }
}

}  // namespace

double required_depth_mm(double radius_mm, double distance_from_skin_end_mm) {
  return std::min(radius_mm, kLeavingSlope * distance_from_skin_end_mm);
}

double strut_excess_mm(const Frame& frame, const Strut& strut, double radius_mm, const Skin& skin) {
  double worst = -std::numeric_limits<double>::infinity();
  walk_axis(frame, strut, skin, [&](double depth, double t) {
    worst = std::max(worst, required_depth_mm(radius_mm, t) - depth);
  });
  return worst;
}

double inside_tolerance_mm(const Skin& skin) { return kToleranceInVoxels * skin.voxel_mm; }

std::vector<double> strut_clearance_mm(const Frame& frame, const Skin& skin) {
  std::vector<double> clearance(frame.struts.size(), std::numeric_limits<double>::infinity());
  for (std::size_t j = 0; j < frame.struts.size(); ++j) {
    if (frame.struts[j].is_skin) continue;
    walk_axis(frame, frame.struts[j], skin, [&](double depth, double t) {
      const double allowed = depth + inside_tolerance_mm(skin);
      if (allowed < kLeavingSlope * t) clearance[j] = std::min(clearance[j], std::max(allowed, 0.0));
    });
  }
  return clearance;
}

double worst_strut_excess_mm(const Frame& frame, const std::vector<double>& radii_mm, const Skin& skin) {
  SKINFRAME_CHECK(radii_mm.size() == frame.struts.size());
  double worst = -std::numeric_limits<double>::infinity();
  for (std::size_t j = 0; j < frame.struts.size(); ++j) {
    if (frame.struts[j].is_skin) continue;
    worst = std::max(worst, strut_excess_mm(frame, frame.struts[j], radii_mm[j], skin));
  }
  return worst;
}

bool struts_inside(const Frame& frame, const std::vector<double>& radii_mm, const Skin& skin) {
  return worst_strut_excess_mm(frame, radii_mm, skin) <= inside_tolerance_mm(skin);
}

}  // namespace skinframe
