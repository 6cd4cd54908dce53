// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/export/keep_wall.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <vector>

namespace skinframe {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

}  // namespace

int keep_wall(TriangleMesh& cavity, const TriangleMesh& closed_mesh, const Skin& skin, double voxel_mm) {
  const auto point = [](const Eigen::Vector3d& v) { return Kernel::Point_3(v.x(), v.y(), v.z()); };
  Triangles triangles;
  triangles.reserve(closed_mesh.triangles.size());
  for (const auto& t : closed_mesh.triangles) {
    const Kernel::Triangle_3 triangle(point(closed_mesh.vertices[t[0]]), point(closed_mesh.vertices[t[1]]),
                                      point(closed_mesh.vertices[t[2]]));
    if (!triangle.is_degenerate()) triangles.push_back(triangle);
  }
  Tree tree(triangles.begin(), triangles.end());
  tree.build();
  tree.accelerate_distance_queries();

  int moved = 0;
  for (Eigen::Vector3d& vertex : cavity.vertices) {
    // The field is never too shallow by more than its voxel: what it sees deeper is a strut's, not the
    // wall's.
    if (-skin.field.at(vertex) > skin.thickness_mm + voxel_mm) continue;
    const Kernel::Point_3 nearest = tree.closest_point(point(vertex));
    const Eigen::Vector3d foot(nearest.x(), nearest.y(), nearest.z());
    const double depth = (vertex - foot).norm();
    if (depth >= skin.thickness_mm - kWallSlackInVoxels * voxel_mm || depth == 0) continue;
    const Eigen::Vector3d there = foot + (vertex - foot) * (skin.thickness_mm / depth);
    vertex = there.cast<float>().cast<double>();
    ++moved;
  }
  return moved;
}

}  // namespace skinframe
