// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/solid/exact_union.h"

#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>

#include <exception>
#include <new>
#include <utility>

#include "worker/solid/surface_mesh.h"

namespace skinframe {

namespace PMP = CGAL::Polygon_mesh_processing;

namespace {

CgalMesh surface_of(const TriangleMesh& body) {
  PolygonSoupOfCgal soup = to_cgal_soup(body);
  PMP::orient_polygon_soup(soup.points, soup.triangles);
  CgalMesh surface;
  PMP::polygon_soup_to_polygon_mesh(soup.points, soup.triangles, surface);
  return surface;
}

}  // namespace

std::optional<TriangleMesh> unite_exactly(const std::vector<TriangleMesh>& bodies,
                                          const RunContext& context) {
  try {
    std::vector<CgalMesh> parts;
    for (const TriangleMesh& body : bodies) {
      parts.push_back(surface_of(body));
      if (!CGAL::is_closed(parts.back())) return std::nullopt;
    }
    // In pairs, and the results in pairs again: each triangle is cut a logarithm of times.
    while (parts.size() > 1) {
      std::vector<CgalMesh> united;
      for (std::size_t i = 0; i + 1 < parts.size(); i += 2) {
        if (context.cancelled()) return std::nullopt;
        if (!PMP::corefine_and_compute_union(parts[i], parts[i + 1], united.emplace_back(),
                                             CGAL::parameters::throw_on_self_intersection(true))) {
          return std::nullopt;
        }
        united.back().collect_garbage();
      }
      if (parts.size() % 2 == 1) united.push_back(std::move(parts.back()));
      parts = std::move(united);
    }
    return from_cgal(parts.front());
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    return std::nullopt;  // the caller has a way without it
  }
}

std::optional<TriangleMesh> unite_with_itself(const TriangleMesh& body) {
  try {
    CgalMesh surface = surface_of(body);
    if (!PMP::experimental::autorefine_and_remove_self_intersections(surface)) return std::nullopt;
    surface.collect_garbage();
    if (!CGAL::is_closed(surface) || PMP::does_self_intersect(surface)) return std::nullopt;
    return from_cgal(surface);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

}  // namespace skinframe
