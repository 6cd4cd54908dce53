// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/skin/triangle_tree.h"

#include <cmath>
#include <limits>

#include "worker/skin/box_tree.h"
#include "worker/skin/nearest_on_triangle.h"

namespace skinframe {
namespace {

std::vector<Corners> triangles_with_area(const TriangleMesh& mesh) {
  std::vector<Corners> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    const Corners t{mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]};
    if ((t[1] - t[0]).cross(t[2] - t[0]).squaredNorm() > 0.0) triangles.push_back(t);
  }
  return triangles;
}

// Whether the line passes the side from p to q on its left, seen along the line. Two triangles with the side
// in common get opposite answers, bit by bit. A line that meets the side, or ends of sides, is judged as if
// it were moved by (e, e^2, e^3) with e next to nothing: so no triangle is met twice or never.
bool is_left(const Eigen::Vector3d& from, const Eigen::Vector3d& direction, const Eigen::Vector3d& p,
             const Eigen::Vector3d& q) {
  const double side = direction.dot((p - from).cross(q - from));
  if (side != 0.0) return side > 0.0;
  const Eigen::Vector3d moved = direction.cross(q - p);
  for (int k = 0; k < 3; ++k)
    if (moved[k] != 0.0) return moved[k] > 0.0;
  return direction.dot(q - p) > 0.0;  // seen end on: it has no two sides
}

// Whether the box meets the part of the line from `from` to `most` along the direction.
bool meets(const Eigen::AlignedBox3f& box, const Eigen::Vector3d& from, const Eigen::Vector3d& direction,
           double most) {
  double low = 0.0, high = most;
  for (int k = 0; k < 3; ++k) {
    if (direction[k] == 0.0) {
      if (from[k] < box.min()[k] || from[k] > box.max()[k]) return false;
      continue;
    }
    const double a = (box.min()[k] - from[k]) / direction[k], b = (box.max()[k] - from[k]) / direction[k];
    low = std::max(low, std::min(a, b));
    high = std::min(high, std::max(a, b));
  }
  // Rounding must not part the line from a box without depth.
  return low <= high + 1e-9 * (1.0 + std::abs(high));
}

}  // namespace

struct TriangleTree::Impl {
  explicit Impl(const TriangleMesh& mesh) : triangles(triangles_with_area(mesh)), tree(boxes()) {}

  std::vector<Eigen::AlignedBox3f> boxes() const {
    std::vector<Eigen::AlignedBox3f> all;
    all.reserve(triangles.size());
    for (const Corners& t : triangles) {
      Eigen::AlignedBox3d box(t[0]);
      box.extend(t[1]);
      box.extend(t[2]);
      all.push_back(box_around(box));
    }
    return all;
  }

  // visit(way, outward) of every triangle that the line meets between `from` and `most` along it.
  template <class Visit>
  void cross(const Eigen::Vector3d& from, const Eigen::Vector3d& direction, double most, Visit visit) const {
    tree.search(
        [&](const Eigen::AlignedBox3f& box) { return meets(box, from, direction, most); },
        [&](int item) {
          const Corners& t = triangles[item];
          const bool left = is_left(from, direction, t[0], t[1]);
          if (left != is_left(from, direction, t[1], t[2]) || left != is_left(from, direction, t[2], t[0]))
            return;
          const Eigen::Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]);
          const double rise = normal.dot(direction);
          if (rise == 0.0) return;
          const double way = normal.dot(t[0] - from) / rise;
          if (way >= 0.0 && way <= most) visit(way, rise > 0.0);
        });
  }

  std::vector<Corners> triangles;
  BoxTree tree;
};

TriangleTree::TriangleTree(const TriangleMesh& mesh) : impl_(std::make_unique<Impl>(mesh)) {}

TriangleTree::~TriangleTree() = default;

Eigen::Vector3d TriangleTree::nearest(const Eigen::Vector3d& p) const {
  double least = std::numeric_limits<double>::infinity();
  Eigen::Vector3d nearest = p;
  impl_->tree.approach(p, least, [&](int item) {
    const Eigen::Vector3d at = nearest_on_triangle(p, impl_->triangles[item]);
    const double squared = (at - p).squaredNorm();
    if (squared >= least) return;
    least = squared;
    nearest = at;
  });
  return nearest;
}

double TriangleTree::distance_mm(const Eigen::Vector3d& p) const { return (p - nearest(p)).norm(); }

bool TriangleTree::is_within(const Eigen::Vector3d& p, double most) const {
  if (!(most >= 0.0)) return false;
  constexpr double kRounding = 1e-12;  // of a square and its root: what is let through is looked at exactly
  double limit = std::nextafter(most * most * (1.0 + kRounding), std::numeric_limits<double>::infinity());
  bool found = false;
  impl_->tree.approach(p, limit, [&](int item) {
    const Eigen::Vector3d at = nearest_on_triangle(p, impl_->triangles[item]);
    if (found || std::sqrt((at - p).squaredNorm()) > most) return;
    found = true;
    limit = 0.0;  // nothing is nearer: the search ends
  });
  return found;
}

bool TriangleTree::is_inside(const Eigen::Vector3d& p) const {
  const Eigen::Vector3d direction(0.3567, 0.7193, 0.5961);  // along no axis and no likely facet
  int out = 0;
  impl_->cross(p, direction, std::numeric_limits<double>::infinity(),
               [&](double, bool outward) { out += outward ? 1 : -1; });
  return out > 0;
}

double TriangleTree::way_out(const Eigen::Vector3d& from, const Eigen::Vector3d& direction,
                             double most) const {
  double nearest = most;
  impl_->cross(from, direction, most, [&](double way, bool outward) {
    if (outward) nearest = std::min(nearest, way);
  });
  return nearest;
}

}  // namespace skinframe
