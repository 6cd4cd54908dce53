// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/skin/triangle_tree.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <cmath>
#include <vector>

namespace skinframe {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Kernel::Point_3 point(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
Kernel::Vector_3 vector(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

double along_normal(const Kernel::Triangle_3& t, const Kernel::Vector_3& direction) {
  return CGAL::cross_product(t[1] - t[0], t[2] - t[0]) * direction;
}

}  // namespace

struct TriangleTree::Impl {
  Triangles triangles;
  Tree tree;
};

TriangleTree::TriangleTree(const TriangleMesh& mesh) : impl_(std::make_unique<Impl>()) {
  impl_->triangles.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles) {
    const Kernel::Triangle_3 triangle(point(mesh.vertices[t[0]]), point(mesh.vertices[t[1]]),
                                      point(mesh.vertices[t[2]]));
    if (!triangle.is_degenerate()) impl_->triangles.push_back(triangle);
  }
  impl_->tree.insert(impl_->triangles.cbegin(), impl_->triangles.cend());
  impl_->tree.build();
  impl_->tree.accelerate_distance_queries();
}

TriangleTree::~TriangleTree() = default;

Eigen::Vector3d TriangleTree::nearest(const Eigen::Vector3d& p) const {
  const Kernel::Point_3 q = impl_->tree.closest_point(point(p));
  return {q.x(), q.y(), q.z()};
}

double TriangleTree::distance_mm(const Eigen::Vector3d& p) const { return (p - nearest(p)).norm(); }

bool TriangleTree::is_inside(const Eigen::Vector3d& p) const {
  const Kernel::Vector_3 direction(0.3567, 0.7193, 0.5961);  // along no axis and no likely facet
  std::vector<Tree::Primitive_id> hits;
  impl_->tree.all_intersected_primitives(Kernel::Ray_3(point(p), direction), std::back_inserter(hits));
  int out = 0;
  for (const auto& hit : hits) out += along_normal(*hit, direction) > 0.0 ? 1 : -1;
  return out > 0;
}

double TriangleTree::way_out(const Eigen::Vector3d& from, const Eigen::Vector3d& direction,
                             double most) const {
  std::vector<Tree::Intersection_and_primitive_id<Kernel::Segment_3>::Type> hits;
  impl_->tree.all_intersections(Kernel::Segment_3(point(from), point(from + most * direction)),
                                std::back_inserter(hits));
  double nearest = most;
  for (const auto& hit : hits) {
    const auto* p = boost::get<Kernel::Point_3>(&hit.first);
    if (p == nullptr || along_normal(*hit.second, vector(direction)) <= 0.0) continue;
    nearest = std::min(nearest, (Eigen::Vector3d(p->x(), p->y(), p->z()) - from).dot(direction));
  }
  return nearest;
}

}  // namespace skinframe
