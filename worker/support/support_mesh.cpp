// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/support/support_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace skinframe {
namespace {

using Eigen::Vector3d;
using On = SupportNode::On;

constexpr double kSinkInSkins = 0.25;      // of a neck into M
constexpr double kMostNeckShare = 0.3;     // of the strut's length outside of M
constexpr double kShortestShellMm = 0.01;  // nothing is made of less

struct Ring {
  double at_mm;  // along the axis
  double radius_mm;
};

void add_shell(const Vector3d& from, const Vector3d& unit, const std::vector<Ring>& rings,
               TriangleMesh& mesh) {
  const Vector3d side = unit.unitOrthogonal(), other = unit.cross(side);
  const int first = static_cast<int>(mesh.vertices.size()), last = static_cast<int>(rings.size()) - 1;
  const auto corner = [&](int ring, int k) { return first + ring * kSides + k % kSides; };
  for (const Ring& ring : rings)
    for (int k = 0; k < kSides; ++k) {
      const double angle = 2 * std::numbers::pi * k / kSides;
      const Vector3d p =
          from + ring.at_mm * unit + ring.radius_mm * (std::cos(angle) * side + std::sin(angle) * other);
      mesh.vertices.push_back(p.cast<float>().cast<double>());
    }
  for (int ring = 0; ring < last; ++ring)
    for (int k = 0; k < kSides; ++k) {
      mesh.triangles.push_back({corner(ring, k), corner(ring, k + 1), corner(ring + 1, k + 1)});
      mesh.triangles.push_back({corner(ring, k), corner(ring + 1, k + 1), corner(ring + 1, k)});
    }
  for (int k = 1; k + 1 < kSides; ++k) {
    mesh.triangles.push_back({corner(0, 0), corner(0, k + 1), corner(0, k)});
    mesh.triangles.push_back({corner(last, 0), corner(last, k), corner(last, k + 1)});
  }
}

// The way along the axis at which it has left M; 0 where it does not within the half of it.
double way_out_mm(const PrintedBody& body, const Vector3d& from, const Vector3d& to) {
  const double length = (to - from).norm(), step = 0.25 * body.step_mm;
  for (double s = 0.0; s <= 0.5 * length; s += step)
    if (body.depth_mm(from + s / length * (to - from)) <= 0.0) return s;
  return 0.0;
}

}  // namespace

TriangleMesh support_mesh(const Frame& frame, const SupportPlan& plan, SupportKind kind,
                          const PrintedBody& body, const Neck& neck) {
  const int own = static_cast<int>(frame.nodes_mm.size());
  const auto touches_body = [&](int node) {
    return node < own ||
           (plan.nodes[node - own].on != On::kSupport && plan.nodes[node - own].on != On::kPlate);
  };
  TriangleMesh mesh;
  for (const SupportStrut& strut : plan.struts) {
    if (strut.kind != kind) continue;
    const Vector3d &upper = node_mm(frame, plan, strut.upper), &lower = node_mm(frame, plan, strut.lower);
    const Vector3d unit = (lower - upper).normalized();
    double begin = 0.0, end = (lower - upper).norm();
    std::vector<Ring> rings;
    if (kind == SupportKind::kExternal) {
      const bool neck_above = touches_body(strut.upper), neck_below = touches_body(strut.lower);
      const double sink = kSinkInSkins * body.skin_thickness_mm,
                   thin = std::min(neck.radius_mm, strut.radius_mm);
      const double out_above = neck_above ? way_out_mm(body, upper, lower) : 0.0;
      const double out_below = neck_below ? way_out_mm(body, lower, upper) : 0.0;
      const double neck_length = std::min(neck.length_mm, kMostNeckShare * (end - out_above - out_below));
      if (end - out_above - out_below < kShortestShellMm) continue;
      if (neck_above) {
        rings.push_back({std::max(out_above - sink, 0.0), thin});
        begin = out_above + neck_length;
      }
      rings.push_back({begin, strut.radius_mm});
      rings.push_back({end - (neck_below ? out_below + neck_length : 0.0), strut.radius_mm});
      if (neck_below) rings.push_back({std::min(end - out_below + sink, end), thin});
    } else {
      rings = {{begin, strut.radius_mm}, {end, strut.radius_mm}};
    }
    add_shell(upper, unit, rings, mesh);
  }
  return mesh;
}

}  // namespace skinframe
