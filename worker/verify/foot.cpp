// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/verify/foot.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace skinframe {
namespace {

using Eigen::Vector3d;

struct Share {
  double z_mm, area_mm2;
};

// What each node of the surface has about it, lowest first; nodes appear once a triangle.
std::vector<Share> shares_of(const TetMesh& mesh) {
  std::vector<Share> shares;
  for (const auto& face : boundary_of(mesh)) {
    const Vector3d* p[3];
    for (int k = 0; k < 3; ++k) p[k] = &mesh.vertices_mm[face[k]];
    const double area = (*p[1] - *p[0]).cross(*p[2] - *p[0]).norm() / 2;
    for (int k = 0; k < 3; ++k) {
      shares.push_back({p[k]->z(), area / 12});
      shares.push_back({(p[k]->z() + p[(k + 1) % 3]->z()) / 2, area / 4});
    }
  }
  std::sort(shares.begin(), shares.end(), [](const Share& a, const Share& b) { return a.z_mm < b.z_mm; });
  return shares;
}

}  // namespace

Foot foot_of(const TriangleMesh& body, double top_z_mm) {
  Foot foot;
  foot.top_z_mm = top_z_mm;
  double rim = 0, plan = 0;
  for (const auto& triangle : body.triangles) {
    std::vector<Vector3d> low, cuts;
    for (int k = 0; k < 3; ++k) {
      const Vector3d &a = body.vertices[triangle[k]], &b = body.vertices[triangle[(k + 1) % 3]];
      if (a.z() <= top_z_mm) low.push_back(a);
      if ((a.z() <= top_z_mm) == (b.z() <= top_z_mm)) continue;
      cuts.push_back(a + (top_z_mm - a.z()) / (b.z() - a.z()) * (b - a));
      low.push_back(cuts.back());
    }
    if (cuts.size() == 2) rim += (cuts[1] - cuts[0]).norm();
    const int first = static_cast<int>(foot.surface.vertices.size());
    for (int k = 2; k < static_cast<int>(low.size()); ++k) {
      const Vector3d twice = (low[k - 1] - low[0]).cross(low[k] - low[0]);
      foot.area_mm2 += twice.norm() / 2;
      plan += std::abs(twice.z()) / 2;
      foot.surface.triangles.push_back({first, first + k - 1, first + k});
    }
    foot.surface.vertices.insert(foot.surface.vertices.end(), low.begin(), low.end());
  }
  foot.width_mm = rim > 0 ? 2 * plan / rim : std::numeric_limits<double>::infinity();
  return foot;
}

double held_height_mm(const TetMesh& mesh, const Foot& foot) {
  double area = 0, height = foot.top_z_mm;
  for (const Share& share : shares_of(mesh)) {
    if (share.z_mm > foot.top_z_mm && area >= foot.area_mm2) break;
    area += share.area_mm2;
    height = std::max(height, share.z_mm);
  }
  return height;
}

double area_held_mm2(const TetMesh& mesh, double height_mm) {
  double area = 0;
  for (const Share& share : shares_of(mesh))
    if (share.z_mm <= height_mm) area += share.area_mm2;
  return area;
}

}  // namespace skinframe
