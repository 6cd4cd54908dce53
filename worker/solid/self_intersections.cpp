// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/solid/self_intersections.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <utility>
#include <vector>

namespace skinframe {

namespace PMP = CGAL::Polygon_mesh_processing;

std::size_t count_self_intersections(const TriangleMesh& mesh) {
  using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
  using SurfaceMesh = CGAL::Surface_mesh<Point>;
  std::vector<Point> points;
  points.reserve(mesh.vertices.size());
  for (const Eigen::Vector3d& p : mesh.vertices) points.emplace_back(p.x(), p.y(), p.z());
  std::vector<std::vector<std::size_t>> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    triangles.push_back(
        {static_cast<std::size_t>(a), static_cast<std::size_t>(b), static_cast<std::size_t>(c)});
  }
  PMP::orient_polygon_soup(points, triangles);  // gives every umbrella a vertex, as Surface_mesh wants it
  SurfaceMesh surface;
  PMP::polygon_soup_to_polygon_mesh(points, triangles, surface);
  std::vector<std::pair<SurfaceMesh::Face_index, SurfaceMesh::Face_index>> pairs;
  PMP::self_intersections(surface, std::back_inserter(pairs));
  return pairs.size();
}

}  // namespace skinframe
