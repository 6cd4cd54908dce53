// SPDX-License-Identifier: GPL-3.0-or-later
// From and to CGAL's half-edge mesh, for the .cpp files of this room that call CGAL; slow to compile.
#pragma once

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>

#include <vector>

#include "worker/mesh/triangle_mesh.h"

namespace skinframe {

using CgalKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalMesh = CGAL::Surface_mesh<CgalKernel::Point_3>;

struct PolygonSoupOfCgal {
  std::vector<CgalKernel::Point_3> points;
  std::vector<std::vector<std::size_t>> triangles;
};

inline PolygonSoupOfCgal to_cgal_soup(const TriangleMesh& mesh) {
  PolygonSoupOfCgal soup;
  soup.points.reserve(mesh.vertices.size());
  for (const Eigen::Vector3d& p : mesh.vertices) soup.points.emplace_back(p.x(), p.y(), p.z());
  soup.triangles.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    soup.triangles.push_back(
        {static_cast<std::size_t>(a), static_cast<std::size_t>(b), static_cast<std::size_t>(c)});
  }
  return soup;
}

inline TriangleMesh from_cgal(const CgalMesh& surface) {
  TriangleMesh mesh;
  std::vector<int> number(surface.num_vertices(), -1);
  for (const auto v : surface.vertices()) {
    number[v] = static_cast<int>(mesh.vertices.size());
    const auto& p = surface.point(v);
    mesh.vertices.emplace_back(p.x(), p.y(), p.z());
  }
  mesh.triangles.reserve(surface.number_of_faces());
  for (const auto f : surface.faces()) {
    std::array<int, 3> triangle{};
    int k = 0;
    for (const auto v : surface.vertices_around_face(surface.halfedge(f))) triangle[k++] = number[v];
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

}  // namespace skinframe
