// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/mesh/triangulate_polygon.h"

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>

namespace skinframe {
namespace {

using Point = Eigen::Vector2d;

double cross(const Point& o, const Point& a, const Point& b) {
  return (a.x() - o.x()) * (b.y() - o.y()) - (a.y() - o.y()) * (b.x() - o.x());
}

// The outline seen against its Newell normal: there it turns counter-clockwise.
std::vector<Point> flatten(std::span<const int> corners, const std::vector<Eigen::Vector3d>& vertices) {
  const Eigen::Vector3d origin = vertices[corners[0]];
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d p = vertices[corners[i]] - origin;
    const Eigen::Vector3d q = vertices[corners[(i + 1) % corners.size()]] - origin;
    normal += p.cross(q);
  }
  Eigen::Vector3d u = normal.unitOrthogonal();
  const Eigen::Vector3d v = normal.normalized().cross(u);
  std::vector<Point> flat;
  flat.reserve(corners.size());
  for (const int corner : corners) {
    const Eigen::Vector3d p = vertices[corner] - origin;
    flat.emplace_back(p.dot(u), p.dot(v));
  }
  return flat;
}

// The ring of corners not yet cut off.
struct Ring {
  std::vector<std::size_t> next;
  std::vector<std::size_t> previous;
};

bool is_ear(std::size_t tip, const Ring& ring, const std::vector<Point>& flat, std::uint64_t* steps_left) {
  const Point& a = flat[ring.previous[tip]];
  const Point& b = flat[tip];
  const Point& c = flat[ring.next[tip]];
  if (!(cross(a, b, c) > 0)) return false;
  for (std::size_t i = ring.next[ring.next[tip]]; i != ring.previous[tip]; i = ring.next[i]) {
    if (*steps_left == 0) return false;
    --*steps_left;
    const Point& p = flat[i];
    // A corner visited twice (the slit that joins a hole to its outline) does not block its own ear.
    if (p == a || p == b || p == c) continue;
    if (cross(a, b, p) >= 0 && cross(b, c, p) >= 0 && cross(c, a, p) >= 0) return false;
  }
  return true;
}

}  // namespace

Triangulation triangulate_polygon(std::span<const int> corners, const std::vector<Eigen::Vector3d>& vertices,
                                  std::vector<std::array<int, 3>>& triangles, std::uint64_t* steps_left) {
  const std::size_t n = corners.size();
  if (n < 3) return Triangulation::kClean;
  if (n == 3) {
    triangles.push_back({corners[0], corners[1], corners[2]});
    return Triangulation::kClean;
  }
  const std::vector<Point> flat = flatten(corners, vertices);
  Ring ring{std::vector<std::size_t>(n), std::vector<std::size_t>(n)};
  for (std::size_t i = 0; i < n; ++i) {
    ring.next[i] = (i + 1) % n;
    ring.previous[i] = (i + n - 1) % n;
  }
  std::size_t left = n;
  std::size_t tip = 1;
  std::size_t refused = 0;  // in a row
  while (left > 3 && refused < left) {
    if (*steps_left == 0) return Triangulation::kTooLong;
    --*steps_left;
    if (is_ear(tip, ring, flat, steps_left)) {
      const std::size_t before = ring.previous[tip];
      const std::size_t after = ring.next[tip];
      triangles.push_back({corners[before], corners[tip], corners[after]});
      ring.next[before] = after;
      ring.previous[after] = before;
      --left;
      refused = 0;
      tip = ring.next[after];  // skipping one spreads the cuts: fewer needles than a fan
    } else {
      ++refused;
      tip = ring.next[tip];
    }
  }
  const bool clean = left == 3;
  for (std::size_t b = ring.next[tip]; ring.next[b] != tip; b = ring.next[b]) {
    triangles.push_back({corners[tip], corners[b], corners[ring.next[b]]});
  }
  return clean ? Triangulation::kClean : Triangulation::kGuessed;
}

}  // namespace skinframe
