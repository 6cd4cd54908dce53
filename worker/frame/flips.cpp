// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/frame/flips.h"

#include <CGAL/boost/graph/Euler_operations.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace skinframe {
namespace {

constexpr int kSweeps = 5;
constexpr double kDelaunaySlack = 1e-3;  // radians
constexpr double kFoldCosine = 0.3;      // of the two normals: sharper folds only where they were sharper yet

struct Diamond {  // a-b is the edge, c and d look at it
  HalfEdgeMesh::Vertex_index va, vb, vc, vd;
  Eigen::Vector3d a, b, c, d;
};

Diamond diamond_about(const HalfEdgeMesh& mesh, HalfEdgeMesh::Halfedge_index h) {
  const auto o = mesh.opposite(h);
  const auto va = mesh.source(h), vb = mesh.target(h), vc = mesh.target(mesh.next(h)),
             vd = mesh.target(mesh.next(o));
  const auto at = [&](auto v) { return to_eigen(mesh.point(v)); };
  return {va, vb, vc, vd, at(va), at(vb), at(vc), at(vd)};
}

}  // namespace

double angle_at(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& r) {
  return std::atan2((q - p).cross(r - p).norm(), (q - p).dot(r - p));
}

bool may_flip(const HalfEdgeMesh& mesh, HalfEdgeMesh::Halfedge_index h) {
  const auto [va, vb, vc, vd, a, b, c, d] = diamond_about(mesh, h);
  if (vc == vd || mesh.halfedge(vc, vd).is_valid()) return false;
  if (mesh.degree(va) <= 3 || mesh.degree(vb) <= 3) return false;
  const Eigen::Vector3d left = (b - a).cross(c - a), right = (d - a).cross(b - a), mean = left + right;
  const Eigen::Vector3d near_b = (d - c).cross(b - c), near_a = (a - c).cross(d - c);
  const double before = left.dot(right) / (left.norm() * right.norm() + 1e-30);
  const double after = near_a.dot(near_b) / (near_a.norm() * near_b.norm() + 1e-30);
  return after >= std::min(kFoldCosine, before - 1e-6) && near_a.dot(mean) * near_b.dot(mean) > 0.0;
}

void flip_to_delaunay(HalfEdgeMesh& mesh, const FlipRule& allowed) {
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    bool changed = false;
    for (auto e : mesh.edges()) {
      const auto h = mesh.halfedge(e);
      const auto [va, vb, vc, vd, a, b, c, d] = diamond_about(mesh, h);
      if (angle_at(c, a, b) + angle_at(d, a, b) <= std::numbers::pi + kDelaunaySlack) continue;
      if (!may_flip(mesh, h) || (allowed && !allowed(h))) continue;
      CGAL::Euler::flip_edge(h, mesh);
      changed = true;
    }
    if (!changed) return;
  }
}

}  // namespace skinframe
