// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/solid/contact.h"

#include <algorithm>
#include <limits>

namespace skinframe {
namespace {

using Point = Eigen::Vector2d;

double cross(const Point& o, const Point& a, const Point& b) {
  return (a.x() - o.x()) * (b.y() - o.y()) - (a.y() - o.y()) * (b.x() - o.x());
}

double distance_to_segment(const Point& p, const Point& a, const Point& b) {
  const Point ab = b - a;
  const double length2 = ab.squaredNorm();
  const double t = length2 > 0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
  return (p - (a + t * ab)).norm();
}

}  // namespace

Polygon2 convex_hull(std::vector<Point> points) {
  std::sort(points.begin(), points.end(),
            [](const Point& a, const Point& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  Polygon2 hull;
  const auto add = [&hull](const Point& p, std::size_t fixed) {
    while (hull.size() > fixed && cross(hull[hull.size() - 2], hull.back(), p) <= 0) hull.pop_back();
    hull.push_back(p);
  };
  for (const Point& p : points) add(p, 1);
  const std::size_t lower = hull.size();
  for (auto p = points.rbegin() + 1; p != points.rend(); ++p) add(*p, lower);
  hull.pop_back();  // the first point again
  return hull;
}

Polygon2 contact_hull(const TriangleMesh& mesh, double tolerance_mm) {
  const double top = bounding_box(mesh).min.z() + tolerance_mm;
  std::vector<Point> points;
  for (const auto& triangle : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d& a = mesh.vertices[triangle[k]];
      const Eigen::Vector3d& b = mesh.vertices[triangle[(k + 1) % 3]];
      if (a.z() <= top) points.emplace_back(a.head<2>());
      if ((a.z() < top && b.z() > top) || (a.z() > top && b.z() < top)) {
        const double t = (top - a.z()) / (b.z() - a.z());
        points.emplace_back((a + t * (b - a)).head<2>());
      }
    }
  }
  return convex_hull(std::move(points));
}

Polygon2 inscribed_polygon(Polygon2 hull, int max_corners) {
  SKINFRAME_CHECK(max_corners >= 3);
  while (hull.size() > static_cast<std::size_t>(max_corners)) {
    std::size_t least = 0;
    double least_area = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < hull.size(); ++i) {
      const Point& before = hull[(i + hull.size() - 1) % hull.size()];
      const double area = cross(before, hull[i], hull[(i + 1) % hull.size()]);
      if (area < least_area) {
        least = i;
        least_area = area;
      }
    }
    hull.erase(hull.begin() + static_cast<std::ptrdiff_t>(least));
  }
  return hull;
}

double signed_margin_mm(const Polygon2& hull, const Point& point) {
  double nearest = std::numeric_limits<double>::infinity();
  bool inside = hull.size() >= 3;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Point& a = hull[i];
    const Point& b = hull[(i + 1) % hull.size()];
    nearest = std::min(nearest, distance_to_segment(point, a, b));
    inside = inside && cross(a, b, point) >= 0;
  }
  return inside ? nearest : -nearest;
}

Contact find_contact(const Solid& solid, double tolerance_mm) {
  Contact contact;
  contact.hull = contact_hull(solid.mesh(), tolerance_mm);
  contact.plane_z_mm = solid.box().min.z();
  contact.margin_mm = signed_margin_mm(contact.hull, solid.centroid_mm().head<2>());
  contact.stands = contact.margin_mm > 0;
  return contact;
}

}  // namespace skinframe
