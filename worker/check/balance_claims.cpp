// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numbers>

#include "worker/check/claims.h"

namespace skinframe::check {
namespace {

constexpr double kContactToleranceMm = 1.0;  // the base contact: surface within this of the lowest plane
constexpr double kMarginToleranceMm = 0.05;  // reported against recomputed

using Polygon = std::vector<Eigen::Vector2d>;

// Corners of all triangles cut off below z.
Polygon contact_points(const TriangleMesh& mesh, double z) {
  Polygon points;
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d &p = mesh.vertices[t[k]], &q = mesh.vertices[t[(k + 1) % 3]];
      if (p.z() <= z) points.emplace_back(p.head<2>());
      if ((p.z() <= z) != (q.z() <= z)) {
        const double s = (z - p.z()) / (q.z() - p.z());
        points.emplace_back((p + s * (q - p)).head<2>());
      }
    }
  return points;
}

double cross(const Eigen::Vector2d& o, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return (a - o).x() * (b - o).y() - (a - o).y() * (b - o).x();
}

// Andrew's monotone chain, counter-clockwise.
Polygon convex_hull(Polygon points) {
  std::sort(points.begin(), points.end(),
            [](const auto& p, const auto& q) { return p.x() < q.x() || (p.x() == q.x() && p.y() < q.y()); });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  Polygon hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t start = hull.size();
    for (const auto& p : points) {
      while (hull.size() >= start + 2 && cross(hull[hull.size() - 2], hull.back(), p) <= 0) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  return hull;
}

// Least signed distance to the hull's edges, positive inside.
double margin_mm(const Polygon& hull, const Eigen::Vector2d& p) {
  if (hull.size() < 3) return -std::numeric_limits<double>::infinity();
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Eigen::Vector2d &a = hull[i], &b = hull[(i + 1) % hull.size()];
    least = std::min(least, cross(a, b, p) / (b - a).norm());
  }
  return least;
}

std::string reported(const std::optional<double>& margin_mm) {
  return margin_mm ? fmt::format("{:.3f}", *margin_mm) : "none";
}

bool agrees(const std::optional<double>& reported_mm, double measured_mm) {
  return reported_mm && std::abs(*reported_mm - measured_mm) <= kMarginToleranceMm;
}

}  // namespace

double standing_margin_mm(const TriangleMesh& outer_mesh) {
  return margin_mm(
      convex_hull(contact_points(outer_mesh, bounding_box(outer_mesh).min.z() + kContactToleranceMm)),
      volume_centroid(outer_mesh).head<2>());
}

Eigen::Vector3d nominal_centre_of_gravity_mm(const ExportedFrame& frame) {
  Eigen::Vector3d moment = frame.skin_mass_weight_n * frame.skin_centroid_mm;
  double weight = frame.skin_mass_weight_n;
  for (const ExportedStrut& s : frame.struts) {
    const Eigen::Vector3d &a = frame.nodes_mm[s.a], &b = frame.nodes_mm[s.b];
    const double w =
        frame.density_g_cm3 * 1e-9 * 9810.0 * std::numbers::pi * s.radius_mm * s.radius_mm * (b - a).norm();
    moment += 0.5 * w * (a + b);
    weight += w;
  }
  return moment / weight;
}

void claim_balance(const ExportedPrinter& result, const TriangleMesh& outer_mesh, Verdict* verdict) {
  const ExportedFrame& frame = result.frame;
  const Eigen::Vector3d nominal_centre =
      result.solid() ? volume_centroid(outer_mesh) : nominal_centre_of_gravity_mm(frame);
  const Eigen::Vector2d nominal = nominal_centre.head<2>();
  const Polygon hull =
      convex_hull(contact_points(outer_mesh, bounding_box(outer_mesh).min.z() + kContactToleranceMm));
  const double nominal_margin = margin_mm(hull, nominal);
  const Eigen::Vector2d printed = volume_centroid(*result.merged).head<2>();
  const double printed_margin = margin_mm(hull, printed);
  const double solid_margin = margin_mm(hull, volume_centroid(outer_mesh).head<2>());
  const std::string measured = fmt::format(
      "centre of gravity ({:.2f}, {:.2f}) mm is {:.3f} mm inside the base contact (reported {}); of the "
      "printed mesh {:.3f} mm (reported {}); of the solid {:.3f} mm",
      nominal.x(), nominal.y(), nominal_margin, reported(result.balance_margin_mm), printed_margin,
      reported(result.printed_balance_margin_mm), solid_margin);
  if (result.balance == "holds") {
    verdict->claims.push_back({"balance",
                               nominal_margin >= -1e-6 && printed_margin >= 0 &&
                                   agrees(result.balance_margin_mm, nominal_margin) &&
                                   agrees(result.printed_balance_margin_mm, printed_margin),
                               measured});
  } else if (result.balance == "not_standing") {
    verdict->claims.push_back({"not standing", solid_margin < kMarginToleranceMm,
                               "the solid itself does not stand, so balance is not claimed: " + measured});
  } else {
    verdict->notes.push_back("balance is " + result.balance + ", nothing is claimed: " + measured);
  }
}

}  // namespace skinframe::check
