// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/solid/wrap.h"

#include <CGAL/alpha_wrap_3.h>

#include <exception>
#include <new>

#include "worker/solid/surface_mesh.h"

namespace skinframe {

std::optional<TriangleMesh> wrap_around(const TriangleMesh& mesh, double alpha, double offset) {
  const PolygonSoupOfCgal soup = to_cgal_soup(mesh);
  CgalMesh wrapped;
  try {
    CGAL::alpha_wrap_3(soup.points, soup.triangles, alpha, offset, wrapped);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    return std::nullopt;
  }
  TriangleMesh result = from_cgal(wrapped);
  if (result.triangles.empty()) return std::nullopt;
  return result;
}

}  // namespace skinframe
