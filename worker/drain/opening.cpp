// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/drain/opening.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace skinframe {
namespace {

constexpr double kStepMm = 0.25;
constexpr int kCurveSteps = 8;  // of the rim's curve between two of its corners
constexpr int kBisections = 14;

}  // namespace

Across across(const Opening& opening) {
  const Eigen::Vector3d u = opening.axis.unitOrthogonal();
  return {u, opening.axis.cross(u)};
}

double distance_mm(const Opening& opening, const Eigen::Vector3d& point) {
  const Eigen::Vector3d from = point - opening.centre_mm;
  const double along = from.dot(opening.axis);
  const double beside = std::max((from - along * opening.axis).norm() - opening.radius_mm, 0.0);
  return std::hypot(beside, std::max({along - opening.rise_mm, -opening.clear_mm - along, 0.0}));
}

double distance_mm(const Opening& opening, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const double length = (b - a).norm();
  const double reach = opening.radius_mm + opening.rise_mm + opening.clear_mm;
  double least = std::max((0.5 * (a + b) - opening.centre_mm).norm() - 0.5 * length - reach, 0.0);
  if (least > reach) return least;  // far away: a lower bound serves
  const int steps = std::max(1, static_cast<int>(std::ceil(length / kStepMm)));
  least = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= steps && least > 0.0; ++i)
    least = std::min(least, distance_mm(opening, a + (b - a) * (static_cast<double>(i) / steps)));
  return least;
}

double distance_mm(const std::vector<Opening>& openings, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  double least = std::numeric_limits<double>::infinity();
  for (const Opening& opening : openings) least = std::min(least, distance_mm(opening, a, b));
  return least;
}

double room_mm(const std::vector<Opening>& openings, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return distance_mm(openings, a, b) - kStrutSlackMm;
}

double rim_radius_mm(const Opening& opening, double skin_thickness_mm) {
  return (opening.radius_mm + skin_thickness_mm + kRimSlackMm) / std::cos(std::numbers::pi / kRimNodes);
}

SurfaceHit meet_surface(const Opening& opening, const Eigen::Vector2d& offset, double depth,
                        const Skin& skin) {
  const Across to = across(opening);
  const Eigen::Vector3d foot = opening.centre_mm + offset.x() * to.u + offset.y() * to.v;
  const auto outside = [&](double along) { return skin.field.at(foot + along * opening.axis) > -depth; };
  double high = opening.rise_mm, low = -opening.clear_mm;
  if (!outside(high) || outside(low)) return {};
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (outside(middle) ? high : low) = middle;
  }
  return {true, 0.5 * (low + high)};
}

SharpCurve rim_curve(const Opening& opening, const Skin& skin) {
  const Across to = across(opening);
  const double radius = rim_radius_mm(opening, skin.thickness_mm);
  SharpCurve curve;
  curve.closed = true;
  curve.corners = kRimNodes;
  constexpr int kSteps = kRimNodes * kCurveSteps;
  for (int i = 0; i < kSteps; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kSteps;
    const Eigen::Vector2d offset = radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    const SurfaceHit hit = meet_surface(opening, offset, skin.thickness_mm, skin);
    if (!hit.found) return {};
    curve.points_mm.push_back(opening.centre_mm + offset.x() * to.u + offset.y() * to.v +
                              hit.along_mm * opening.axis);
  }
  curve.points_mm.push_back(curve.points_mm.front());
  return curve;
}

}  // namespace skinframe
