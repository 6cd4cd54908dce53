// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/solid/self_intersections.h"

#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>

#include <algorithm>

#include "worker/solid/surface_mesh.h"

namespace skinframe {

namespace PMP = CGAL::Polygon_mesh_processing;

std::vector<std::pair<int, int>> find_self_intersections(const TriangleMesh& mesh) {
  PolygonSoupOfCgal soup = to_cgal_soup(mesh);
  // Gives every umbrella a vertex, as Surface_mesh wants it; faces keep their order.
  PMP::orient_polygon_soup(soup.points, soup.triangles);
  CgalMesh surface;
  PMP::polygon_soup_to_polygon_mesh(soup.points, soup.triangles, surface);
  std::vector<std::pair<CgalMesh::Face_index, CgalMesh::Face_index>> found;
  PMP::self_intersections(surface, std::back_inserter(found));
  std::vector<std::pair<int, int>> pairs;
  pairs.reserve(found.size());
  for (const auto& [a, b] : found) {
    const int first = static_cast<int>(std::size_t{a}), second = static_cast<int>(std::size_t{b});
    pairs.emplace_back(std::min(first, second), std::max(first, second));
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace skinframe
