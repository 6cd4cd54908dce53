// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/mesh/triangle_mesh.h"

#include <Eigen/Geometry>

namespace skinframe {
namespace {

// Volumes are summed about a point of the mesh, not about the origin: a small part far away would lose its
// digits otherwise.
Eigen::Vector3d reference_point(const TriangleMesh& mesh) { return bounding_box(mesh).min; }

}  // namespace

BoundingBox bounding_box(const TriangleMesh& mesh) {
  BoundingBox box;
  if (mesh.vertices.empty()) return box;
  box.min = box.max = mesh.vertices.front();
  for (const Eigen::Vector3d& v : mesh.vertices) {
    box.min = box.min.cwiseMin(v);
    box.max = box.max.cwiseMax(v);
  }
  return box;
}

double signed_volume(const TriangleMesh& mesh) {
  const Eigen::Vector3d origin = reference_point(mesh);
  double six_volumes = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d p = mesh.vertices[a] - origin;
    six_volumes += p.dot((mesh.vertices[b] - origin).cross(mesh.vertices[c] - origin));
  }
  return six_volumes / 6;
}

double surface_area(const TriangleMesh& mesh) {
  double twice_area = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d& p = mesh.vertices[a];
    twice_area += (mesh.vertices[b] - p).cross(mesh.vertices[c] - p).norm();
  }
  return twice_area / 2;
}

Eigen::Vector3d volume_centroid(const TriangleMesh& mesh) {
  const Eigen::Vector3d origin = reference_point(mesh);
  double six_volumes = 0;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d p = mesh.vertices[a] - origin;
    const Eigen::Vector3d q = mesh.vertices[b] - origin;
    const Eigen::Vector3d r = mesh.vertices[c] - origin;
    const double tetrahedron = p.dot(q.cross(r));
    six_volumes += tetrahedron;
    moment += tetrahedron * (p + q + r) / 4;
  }
  if (six_volumes == 0) return bounding_box(mesh).min + bounding_box(mesh).extent() / 2;
  return origin + moment / six_volumes;
}

std::size_t drop_unused_vertices(TriangleMesh& mesh) {
  std::vector<int> renamed(mesh.vertices.size(), -1);
  for (const auto& triangle : mesh.triangles) {
    for (const int v : triangle) renamed[v] = 0;
  }
  int kept = 0;
  for (std::size_t v = 0; v < renamed.size(); ++v) {
    if (renamed[v] < 0) continue;
    mesh.vertices[kept] = mesh.vertices[v];
    renamed[v] = kept++;
  }
  const std::size_t dropped = mesh.vertices.size() - kept;
  mesh.vertices.resize(kept);
  for (auto& triangle : mesh.triangles) {
    for (int& v : triangle) v = renamed[v];
  }
  return dropped;
}

}  // namespace skinframe
