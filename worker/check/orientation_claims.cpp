// SPDX-License-Identifier: GPL-3.0-or-later
// What an attitude of M would need in support struts, estimated from its triangles: points spread over them
// by chance, and upright lines down from the roofs of the cavity to where M ends below.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include "worker/check/claims.h"

namespace skinframe::check {
namespace {

using Eigen::Vector3d;

constexpr int kPoints = 30'000;
constexpr int kMostColumns = 256;  // a side, of the lattice that triangles are filed in
constexpr std::size_t kMostFiled = 100'000'000;
constexpr double kHeldByPlateMm = 1.0;  // beyond the skin: the contact tolerance
constexpr double kShare = 0.1;          // what two ways of spreading points may differ by
constexpr double kLeastMm3 = 1.0;       // and what that is of nothing
constexpr double kMarginMm = 0.05;
constexpr double kProper = 1e-6;

// Triangles by the columns of the xy plane that their boxes meet.
class Columns {
 public:
  explicit Columns(const TriangleMesh& mesh) : mesh_(mesh), box_(bounding_box(mesh)) {
    side_mm_ = std::max(box_.extent().head<2>().maxCoeff(), 1e-9) / kMostColumns;
    filed_.resize(static_cast<std::size_t>(kMostColumns + 1) * (kMostColumns + 1));
    std::size_t filed = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      const Vector3d &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
      const Vector3d low = p.cwiseMin(q).cwiseMin(r), high = p.cwiseMax(q).cwiseMax(r);
      for (int y = column(low.y(), 1); y <= column(high.y(), 1); ++y)
        for (int x = column(low.x(), 0); x <= column(high.x(), 0); ++x)
          filed_[static_cast<std::size_t>(y) * (kMostColumns + 1) + x].push_back(static_cast<int>(t));
      const auto wide = static_cast<std::size_t>(column(high.x(), 0) - column(low.x(), 0) + 1);
      filed += wide * static_cast<std::size_t>(column(high.y(), 1) - column(low.y(), 1) + 1);
      if (filed > kMostFiled) throw std::length_error("its triangles are too large and too many");
    }
  }

  // How far below a point the body is first left; 0: nowhere.
  double way_down_mm(const Vector3d& from) const {
    if (((from - box_.min).array() < 0).any() || ((box_.max - from).array() < 0).any()) return 0.0;
    double best = std::numeric_limits<double>::infinity();
    for (const int t :
         filed_[static_cast<std::size_t>(column(from.y(), 1)) * (kMostColumns + 1) + column(from.x(), 0)]) {
      const auto& [a, b, c] = mesh_.triangles[static_cast<std::size_t>(t)];
      const Vector3d &p = mesh_.vertices[a], &q = mesh_.vertices[b], &r = mesh_.vertices[c];
      const Vector3d normal = (q - p).cross(r - p);
      if (!(normal.z() < 0)) continue;  // entered here, not left
      const Eigen::Vector2d at = from.head<2>();
      const auto side = [&](const Vector3d& i, const Vector3d& j) {
        const Eigen::Vector2d u = (j - i).head<2>(), v = at - i.head<2>();
        return u.x() * v.y() - u.y() * v.x();
      };
      if (side(p, q) > 0 || side(q, r) > 0 || side(r, p) > 0) continue;  // clockwise, seen from above
      const double z = p.z() - (normal.x() * (at.x() - p.x()) + normal.y() * (at.y() - p.y())) / normal.z();
      if (z <= from.z()) best = std::min(best, from.z() - z);
    }
    return std::isfinite(best) ? best : 0.0;
  }

 private:
  int column(double at, int axis) const {
    return std::clamp(static_cast<int>((at - box_.min[axis]) / side_mm_), 0, kMostColumns);
  }
  const TriangleMesh& mesh_;
  BoundingBox box_;
  double side_mm_;
  std::vector<std::vector<int>> filed_;
};

double estimate_mm3(const TriangleMesh& mesh, const ExportedPrinter& result) {
  const ExportedSupports& supports = *result.supports;
  const double h = result.skin_thickness_mm, lowest = bounding_box(mesh).min.z();
  const double steep = std::sin(supports.self_supporting_angle_deg * std::numbers::pi / 180);
  std::vector<double> up_to;  // area of the triangles so far
  double total = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    up_to.push_back(total +=
                    0.5 *
                    (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).norm());
  const Columns columns(mesh);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  double volume = 0;
  for (int i = 0; i < kPoints; ++i) {
    const double wanted = total * (i + unit(random)) / kPoints;
    const auto t = std::min<std::size_t>(
        static_cast<std::size_t>(std::lower_bound(up_to.begin(), up_to.end(), wanted) - up_to.begin()),
        mesh.triangles.size() - 1);
    const auto& [a, b, c] = mesh.triangles[t];
    const Vector3d &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
    const Vector3d normal = (q - p).cross(r - p).normalized();
    const double root = std::sqrt(unit(random)), share = unit(random);
    const Vector3d at = (1 - root) * p + root * (1 - share) * q + root * share * r;
    if (!(std::abs(normal.z()) > steep)) continue;
    double length = 0;
    if (normal.z() < 0) {
      length = at.z() - lowest;
      if (length <= h + kHeldByPlateMm) continue;
    } else {
      length = columns.way_down_mm(at - h * normal) - h;
      if (length <= h) continue;
    }
    const double degrees = std::asin(std::min(1.0, std::abs(normal.z()))) * 180 / std::numbers::pi;
    const double reach = 0.5 * printable_mm(supports.printable_length, degrees);
    const double slender = result.frame.slenderness ? length / *result.frame.slenderness : 0.0;
    const double radius = std::max(result.eta_mm, slender);
    volume += total / kPoints * radius * radius / (reach * reach) * length;
  }
  return volume;
}

bool is_proper(const Eigen::Matrix3d& rotation) {
  return (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <= kProper &&
         rotation.determinant() > 0;
}

bool same(double measured, double reported) {
  return std::abs(measured - reported) <= kShare * std::max(measured, reported) + kLeastMm3;
}

}  // namespace

void claim_orientation(const ExportedOrientation& orientation, const ExportedPrinter& result,
                       const TriangleMesh& outer_mesh, Verdict* verdict) {
  const ExportedAttitude& chosen = orientation.chosen;
  const double needs = estimate_mm3(outer_mesh, result), margin = standing_margin_mm(outer_mesh);
  bool holds = is_proper(chosen.rotation) && same(needs, chosen.support_estimate_mm3) &&
               std::abs(margin - chosen.standing_margin_mm) <= kMarginMm;
  std::string other = "there is no other";
  if (orientation.runner_up) {
    const ExportedAttitude& next = *orientation.runner_up;
    TriangleMesh turned = outer_mesh;
    for (Vector3d& v : turned.vertices) v = next.rotation * (chosen.rotation.transpose() * v);
    const double would_need = estimate_mm3(turned, result);
    holds = holds && is_proper(next.rotation) && same(would_need, next.support_estimate_mm3) &&
            chosen.support_estimate_mm3 <= next.support_estimate_mm3 * (1 + 1e-6);
    other = fmt::format("the runner-up {:.0f} mm3 (reported {:.0f})", would_need, next.support_estimate_mm3);
  }
  verdict->claims.push_back(
      {"orientation", holds,
       fmt::format("by estimate this attitude needs {:.0f} mm3 of support struts (reported {:.0f}), {}; its "
                   "centroid is {:.2f} mm inside the base contact (reported {:.2f})",
                   needs, chosen.support_estimate_mm3, other, margin, chosen.standing_margin_mm)});
}

}  // namespace skinframe::check
