// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/worker/skin/thin_rays.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <random>
#include <vector>

namespace skinframe::oracle {
namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Triangles = std::vector<Kernel::Triangle_3>;
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>;
using Tree = CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>>;

Kernel::Point_3 point(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

struct Body {
  const TriangleMesh& mesh;
  Triangles triangles;
  Tree tree;

  explicit Body(const TriangleMesh& m) : mesh(m) {
    for (const auto& t : m.triangles)
      triangles.emplace_back(point(m.vertices[t[0]]), point(m.vertices[t[1]]), point(m.vertices[t[2]]));
    tree.insert(triangles.begin(), triangles.end());
    tree.build();
    tree.accelerate_distance_queries();
  }
  double distance(const Eigen::Vector3d& p) const { return std::sqrt(tree.squared_distance(point(p))); }
  // First hit of the ray beyond `from` itself, or `most`.
  double first_hit(const Eigen::Vector3d& from, const Eigen::Vector3d& direction, double most) const {
    constexpr double kSkip = 1e-5;
    const Kernel::Segment_3 segment(point(from + kSkip * direction), point(from + most * direction));
    std::vector<Tree::Intersection_and_primitive_id<Kernel::Segment_3>::Type> hits;
    tree.all_intersections(segment, std::back_inserter(hits));
    double nearest = most;
    for (const auto& hit : hits) {
      if (const auto* p = boost::get<Kernel::Point_3>(&hit.first))
        nearest = std::min(nearest, (Eigen::Vector3d(p->x(), p->y(), p->z()) - from).norm());
    }
    return nearest;
  }
};

// Shells that overlap have surface inside M: crossings of a ray, each with its sign, tell it from the outer
// one.
bool is_outer(const Body& body, const Eigen::Vector3d& p, const Eigen::Vector3d& inward) {
  const Eigen::Vector3d from = p - 1e-4 * inward, along(0.3567, 0.7193, 0.5961);
  const Kernel::Ray_3 ray(point(from), Kernel::Vector_3(along.x(), along.y(), along.z()));
  std::vector<Tree::Primitive_id> hits;
  body.tree.all_intersected_primitives(ray, std::back_inserter(hits));
  int winding = 0;
  for (const auto& hit : hits) {
    const auto normal = CGAL::cross_product((*hit)[1] - (*hit)[0], (*hit)[2] - (*hit)[0]);
    winding += normal * ray.to_vector() > 0 ? 1 : -1;
  }
  return winding == 0;
}

constexpr int kDepths = 8;

}  // namespace

// Every point of M is reached by an inward normal from its nearest surface point. About a face those normals
// are parallel, so their lengths sum to a volume as they are; about a concave edge they are a fan, r dr dphi.
// Concave corners add nothing that counts.
ThinByRays thin_by_rays(const TriangleMesh& mesh, double h, double side) {
  const Body body(mesh);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  ThinByRays result;
  double thin_area = 0, area = 0;
  const auto normal_of = [&](int t) -> Eigen::Vector3d {
    const auto& [a, b, c] = mesh.triangles[t];
    return (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).normalized();
  };
  // The mean of weight(depth) h over depths in 0..h at which `from` is still the nearest point of M.
  const auto reach = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& inward, const auto& weight) {
    constexpr double kSame = 1e-6;
    double sum = 0;
    for (int k = 0; k < kDepths; ++k) {
      const double depth = (k + unit(random)) / kDepths * h;
      if (body.distance(from + depth * inward) >= depth - kSame) sum += weight(depth) * h / kDepths;
    }
    return sum;
  };
  std::map<std::pair<int, int>, int> face_of_edge;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    const auto& [ia, ib, ic] = mesh.triangles[t];
    const Eigen::Vector3d a = mesh.vertices[ia], u = mesh.vertices[ib] - a, v = mesh.vertices[ic] - a;
    const double triangle_area = 0.5 * u.cross(v).norm();
    const Eigen::Vector3d inward = -normal_of(t);
    const int samples = static_cast<int>(std::ceil(triangle_area / (side * side)));
    area += triangle_area;
    for (int i = 0; i < samples; ++i) {
      double r = unit(random), s = unit(random);
      if (r + s > 1) r = 1 - r, s = 1 - s;
      const Eigen::Vector3d p = a + r * u + s * v;
      if (body.first_hit(p, inward, 2 * h) >= 2 * h || !is_outer(body, p, inward)) continue;
      thin_area += triangle_area / samples;
      result.volume_mm3 += triangle_area / samples * reach(p, inward, [](double) { return 1.0; });
    }
    for (int k = 0; k < 3; ++k) face_of_edge[{mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]}] = t;
  }
  for (const auto& [edge, t] : face_of_edge) {
    const auto other = face_of_edge.find({edge.second, edge.first});
    if (edge.first > edge.second || other == face_of_edge.end()) continue;
    const Eigen::Vector3d n = -normal_of(t), m = -normal_of(other->second);
    const Eigen::Vector3d a = mesh.vertices[edge.first], along = mesh.vertices[edge.second] - a;
    if (n.cross(m).dot(along) >= 0) continue;
    const double opening = std::acos(std::clamp(n.dot(m), -1.0, 1.0));
    const int steps = static_cast<int>(std::ceil(along.norm() * opening / side));
    for (int i = 0; i < steps; ++i) {
      const double turn = unit(random) * opening;
      const Eigen::Vector3d inward = (std::sin(opening - turn) * n + std::sin(turn) * m).normalized();
      const Eigen::Vector3d p = a + unit(random) * along;
      if (body.first_hit(p, inward, 2 * h) >= 2 * h) continue;
      result.volume_mm3 +=
          along.norm() * opening / steps * reach(p, inward, [](double depth) { return depth; });
    }
  }
  result.thin_surface_share = thin_area / area;
  return result;
}

}  // namespace skinframe::oracle
