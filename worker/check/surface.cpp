// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/check/surface.h"

#include <CGAL/AABB_face_graph_triangle_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>

#include <cmath>
#include <iterator>
#include <optional>
#include <vector>

namespace skinframe::check {
namespace {
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Primitive = CGAL::AABB_face_graph_triangle_primitive<Mesh>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;
}  // namespace

struct Surface::Impl {
  Mesh mesh;
  Tree tree;
  std::optional<CGAL::Side_of_triangle_mesh<Mesh, Kernel>> side;

  // How often the surface winds around a point: ways out less ways in along a ray, in a direction that no
  // file's edges have.
  int winding(const Kernel::Point_3& p) const {
    const Kernel::Vector_3 direction(0.5773, 0.3391, 0.7427);
    std::vector<Primitive::Id> hit;
    tree.all_intersected_primitives(Kernel::Ray_3(p, direction), std::back_inserter(hit));
    int ways_out = 0;
    for (const auto face : hit) {
      const auto h = mesh.halfedge(face);
      const auto &a = mesh.point(mesh.source(h)), &b = mesh.point(mesh.target(h)),
                 &c = mesh.point(mesh.target(mesh.next(h)));
      ways_out += CGAL::cross_product(b - a, c - a) * direction > 0 ? 1 : -1;
    }
    return ways_out;
  }
};

Surface::Surface(const TriangleMesh& closed_mesh) : impl_(std::make_unique<Impl>()) {
  Mesh& mesh = impl_->mesh;
  std::vector<Kernel::Point_3> points;
  for (const auto& v : closed_mesh.vertices) points.emplace_back(v.x(), v.y(), v.z());
  // Vertices where the surface touches itself are split, so that the soup always makes a mesh.
  std::vector<std::array<int, 3>> triangles = closed_mesh.triangles;
  CGAL::Polygon_mesh_processing::polygon_soup_to_polygon_mesh(points, triangles, mesh);
  impl_->tree.insert(faces(mesh).begin(), faces(mesh).end(), mesh);
  impl_->tree.build();
  impl_->tree.accelerate_distance_queries();
  impl_->side.emplace(impl_->tree);
}

Surface::~Surface() = default;
Surface::Surface(Surface&&) noexcept = default;

double Surface::distance_mm(const Eigen::Vector3d& p) const {
  return std::sqrt(impl_->tree.squared_distance(Kernel::Point_3(p.x(), p.y(), p.z())));
}

Eigen::Vector3d Surface::nearest(const Eigen::Vector3d& p) const {
  const Kernel::Point_3 q = impl_->tree.closest_point(Kernel::Point_3(p.x(), p.y(), p.z()));
  return {q.x(), q.y(), q.z()};
}

double Surface::depth_mm(const Eigen::Vector3d& p) const {
  const double distance = distance_mm(p);
  const Kernel::Point_3 point(p.x(), p.y(), p.z());
  // The library goes by odd and even; what a surface that crosses itself encloses twice is material as well.
  const bool outside = (*impl_->side)(point) == CGAL::ON_UNBOUNDED_SIDE && impl_->winding(point) == 0;
  return outside ? -distance : distance;
}

}  // namespace skinframe::check
