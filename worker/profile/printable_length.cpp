// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/profile/printable_length.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace skinframe {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

double length_of(const PrintableLength::Point& point) { return point.length_mm.value_or(kUnlimited); }

}  // namespace

Result<PrintableLength> PrintableLength::make(std::vector<Point> points, bool is_default,
                                              std::string source) {
  if (points.empty() || points.size() > kMostPoints)
    return invalid_input(fmt::format("{} points; a curve has 1 .. {}", points.size(), kMostPoints));
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point& point = points[i];
    if (!(point.angle_deg >= 0 && point.angle_deg <= 90))
      return invalid_input(fmt::format(
          "points[{}]: angle {:g} is not within 0 .. 90 degrees from the vertical", i, point.angle_deg));
    if (point.length_mm && !(*point.length_mm > 0 && std::isfinite(*point.length_mm)))
      return invalid_input(fmt::format("points[{}]: length {:g} is not > 0", i, *point.length_mm));
    if (i == 0) continue;
    if (!(point.angle_deg > points[i - 1].angle_deg))
      return invalid_input(fmt::format("points[{}]: angle {:g} is not above {:g}, the one before", i,
                                       point.angle_deg, points[i - 1].angle_deg));
    if (length_of(point) > length_of(points[i - 1]))
      return invalid_input(fmt::format(
          "points[{}]: a strut at {:g} degrees prints longer than one at {:g}; a flatter one never does", i,
          point.angle_deg, points[i - 1].angle_deg));
  }
  if (points.back().angle_deg != 90)
    return invalid_input(
        fmt::format("the last angle is {:g}; nothing is known of flatter struts: a curve ends "
                    "with the length of one that lies flat, at 90 degrees",
                    points.back().angle_deg));
  return PrintableLength(std::move(points), is_default, std::move(source));
}

PrintableLength::PrintableLength(std::vector<Point> points, bool is_default, std::string source)
    : points_(std::move(points)), is_default_(is_default), source_(std::move(source)) {}

double PrintableLength::length_mm(double angle_from_vertical_rad) const {
  const double angle_deg = std::clamp(angle_from_vertical_rad * 180 / std::numbers::pi, 0.0, 90.0);
  const auto flatter = std::find_if(points_.begin(), points_.end(),
                                    [&](const Point& point) { return point.angle_deg >= angle_deg; });
  if (flatter == points_.begin() || flatter->angle_deg == angle_deg) return length_of(*flatter);
  const Point& steeper = *(flatter - 1);
  if (!steeper.length_mm || !flatter->length_mm) return length_of(*flatter);
  const double share = (angle_deg - steeper.angle_deg) / (flatter->angle_deg - steeper.angle_deg);
  return std::lerp(*steeper.length_mm, *flatter->length_mm, share);
}

}  // namespace skinframe
