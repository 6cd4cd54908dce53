// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/solid/hole_patch.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/utility.h>

#include <exception>

namespace skinframe {

std::vector<std::array<int, 3>> triangulate_closed_polyline(const std::vector<Eigen::Vector3d>& points) {
  using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
  const int count = static_cast<int>(points.size());
  if (count < 3) return {};
  if (count == 3) return {{0, 1, 2}};
  std::vector<Point> polyline;
  polyline.reserve(points.size());
  for (const Eigen::Vector3d& p : points) polyline.emplace_back(p.x(), p.y(), p.z());
  std::vector<CGAL::Triple<int, int, int>> patch;
  try {
    CGAL::Polygon_mesh_processing::triangulate_hole_polyline(polyline, std::back_inserter(patch));
  } catch (const std::exception&) {
    return {};  // the caller has a way without it
  }
  std::vector<std::array<int, 3>> triangles;
  triangles.reserve(patch.size());
  for (const auto& t : patch) triangles.push_back({t.first % count, t.second % count, t.third % count});
  // One sense for the whole patch: that of the triangle on the edge 0 -> 1.
  for (const auto& t : triangles) {
    for (int k = 0; k < 3; ++k) {
      if (t[k] == 1 && t[(k + 1) % 3] == 0) {
        for (auto& u : triangles) std::swap(u[1], u[2]);
        return triangles;
      }
    }
  }
  return triangles;
}

}  // namespace skinframe
