// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/support/orient_body.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/convex_hull_3.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "worker/skin/triangle_tree.h"
#include "worker/solid/contact.h"
#include "worker/support/printable_curve.h"

namespace skinframe {
namespace {

using Eigen::Vector3d;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

constexpr std::size_t kMostSamples = 20'000;
constexpr int kMostDivisions = 64;      // of a triangle's edge
constexpr double kSameNormal = 0.9998;  // cosine of 1 degree: faces of the hull that are one
constexpr double kLeastGain = 1e-6;     // relative; the body's own attitude wins ties
constexpr double kLongestMm = 1e4;      // nothing in a tray is longer

struct Sample {
  Vector3d at, normal;
  double area_mm2;
};

std::vector<Sample> sample_surface(const TriangleMesh& mesh) {
  const double spacing = std::sqrt(2.0 * surface_area(mesh) / kMostSamples);
  std::vector<Sample> samples;
  double carried = 0.0;  // area of triangles too small for a sample of their own
  const double each = 0.5 * spacing * spacing;
  for (const auto& t : mesh.triangles) {
    const Vector3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const Vector3d cross = (b - a).cross(c - a);
    const double area = 0.5 * cross.norm();
    if (!(area > 0.0)) continue;
    const Vector3d normal = cross.normalized();
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    const int n = std::clamp(static_cast<int>(longest / spacing), 1, kMostDivisions);
    if (n == 1) {
      carried += area;
      if (carried < each) continue;
      samples.push_back({(a + b + c) / 3.0, normal, carried});
      carried = 0.0;
      continue;
    }
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j)
        samples.push_back({a + (i + 1.0 / 3) / n * (b - a) + (j + 1.0 / 3) / n * (c - a), normal,
                           area / (n * n) * (i + j + 1 < n ? 2 : 1)});
  }
  return samples;
}

// Outward normals of the hull's large faces, the largest first.
std::vector<Vector3d> hull_faces(const TriangleMesh& mesh, const OrientOptions& options) {
  std::vector<Kernel::Point_3> points;
  for (const Vector3d& v : mesh.vertices) points.emplace_back(v.x(), v.y(), v.z());
  CGAL::Surface_mesh<Kernel::Point_3> hull;
  CGAL::convex_hull_3(points.begin(), points.end(), hull);
  struct Face {
    Vector3d sum;  // of cross products: twice the area
    Vector3d normal;
  };
  std::vector<Face> faces;
  double total = 0.0;
  for (const auto face : hull.faces()) {
    std::vector<Vector3d> corners;
    for (const auto v : hull.vertices_around_face(hull.halfedge(face))) {
      const auto& p = hull.point(v);
      corners.emplace_back(p.x(), p.y(), p.z());
    }
    const Vector3d cross = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    total += cross.norm();
    if (!(cross.norm() > 0.0)) continue;
    const Vector3d normal = cross.normalized();
    const auto same = std::find_if(faces.begin(), faces.end(),
                                   [&](const Face& f) { return f.normal.dot(normal) > kSameNormal; });
    if (same == faces.end())
      faces.push_back({cross, normal});
    else
      same->sum += cross;
  }
  std::stable_sort(faces.begin(), faces.end(),
                   [](const Face& a, const Face& b) { return a.sum.norm() > b.sum.norm(); });
  std::vector<Vector3d> normals;
  for (const Face& face : faces)
    if (face.sum.norm() >= options.least_share * total &&
        static_cast<int>(normals.size()) < options.most_faces)
      normals.push_back(face.sum.normalized());
  return normals;
}

double estimate_mm3(const std::vector<Sample>& samples, const TriangleTree& body, const Vector3d& down,
                    double lowest, const PrintableLength& curve, const OrientOptions& options) {
  const double flattest = self_supporting_angle(curve), h = options.skin_thickness_mm;
  double volume = 0.0;
  for (const Sample& s : samples) {
    const double facing = s.normal.dot(down);
    if (std::abs(facing) <= std::sin(flattest)) continue;
    double length = 0.0;
    if (facing > 0.0) {
      length = lowest - s.at.dot(down);
      if (length <= h + kContactToleranceMm) continue;  // the base plane holds it
    } else {
      length = body.way_out(s.at - h * s.normal, down, kLongestMm) - h;
      if (length <= h) continue;  // there is no cavity below
    }
    const double reach = 0.5 * curve.length_mm(std::asin(std::min(std::abs(facing), 1.0)));
    const double radius =
        std::max(options.min_radius_mm, options.slenderness ? length / *options.slenderness : 0.0);
    volume += s.area_mm2 / (std::numbers::pi * reach * reach) * std::numbers::pi * radius * radius * length;
  }
  return volume;
}

}  // namespace

std::vector<Attitude> rank_attitudes(const TriangleMesh& closed_mesh, const PrintableLength& curve,
                                     const OrientOptions& options) {
  const std::vector<Sample> samples = sample_surface(closed_mesh);
  const TriangleTree body(closed_mesh);
  const Vector3d centroid = volume_centroid(closed_mesh);
  std::vector<Vector3d> downs{-Vector3d::UnitZ()};
  for (const Vector3d& normal : hull_faces(closed_mesh, options))
    if (normal.dot(downs.front()) <= kSameNormal) downs.push_back(normal);
  std::vector<Attitude> attitudes;
  for (const Vector3d& down : downs) {
    Attitude attitude;
    if (!attitudes.empty())
      attitude.rotation = Eigen::Quaterniond::FromTwoVectors(down, -Vector3d::UnitZ()).toRotationMatrix();
    TriangleMesh turned = closed_mesh;
    for (Vector3d& v : turned.vertices) v = attitude.rotation * v;
    attitude.margin_mm = signed_margin_mm(contact_hull(turned), (attitude.rotation * centroid).head<2>());
    attitude.support_mm3 = estimate_mm3(samples, body, down, -bounding_box(turned).min.z(), curve, options);
    attitudes.push_back(attitude);
  }
  const bool any_stands =
      std::any_of(attitudes.begin(), attitudes.end(), [](const Attitude& a) { return a.margin_mm > 0.0; });
  if (any_stands) std::erase_if(attitudes, [](const Attitude& a) { return !(a.margin_mm > 0.0); });
  std::stable_sort(attitudes.begin(), attitudes.end(),
                   [](const Attitude& a, const Attitude& b) { return a.support_mm3 < b.support_mm3; });
  const auto own = std::find_if(attitudes.begin(), attitudes.end(),
                                [](const Attitude& a) { return a.rotation.isIdentity(); });
  if (own != attitudes.end() && own->support_mm3 <= attitudes.front().support_mm3 * (1.0 + kLeastGain))
    std::rotate(attitudes.begin(), own, own + 1);
  return attitudes;
}

}  // namespace skinframe
