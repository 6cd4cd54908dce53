// SPDX-License-Identifier: GPL-3.0-or-later
// Skin that overhangs further than it prints, from M's own triangles: where M looks up, its inner side is a
// roof of the cavity; where it looks down, an underside.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "worker/check/claims.h"

namespace skinframe::check {
namespace {

using Eigen::Vector3d;

constexpr double kSampleMm = 1.5;         // longest edge of the piece of surface that a sample stands for
constexpr int kMostDivisions = 64;        // of a triangle's edge
constexpr double kToleranceMm = 2.0;      // on the reach: samples here, columns where it was measured
constexpr double kToleranceShare = 0.01;  // of the cavity's surface

struct Sample {
  Vector3d at;
  double area_mm2, reach_mm;
};

// Points by cells of a lattice; asks for one near enough and not above.
class Held {
 public:
  explicit Held(double cell_mm) : cell_mm_(cell_mm) {}
  void add(const Vector3d& p) { cells_[key(p)].push_back(p); }
  bool near(const Vector3d& p, double reach_mm) const {
    const int around = static_cast<int>(std::ceil(reach_mm / cell_mm_));
    const auto middle = key(p);
    for (int x = -around; x <= around; ++x)
      for (int y = -around; y <= around; ++y)
        for (int z = -around; z <= 1; ++z) {
          const auto cell = cells_.find({middle[0] + x, middle[1] + y, middle[2] + z});
          if (cell == cells_.end()) continue;
          for (const Vector3d& q : cell->second)
            if (q.z() <= p.z() + 1.0 && (q - p).norm() <= reach_mm) return true;
        }
    return false;
  }

 private:
  std::array<int, 3> key(const Vector3d& p) const {
    return {static_cast<int>(std::floor(p.x() / cell_mm_)), static_cast<int>(std::floor(p.y() / cell_mm_)),
            static_cast<int>(std::floor(p.z() / cell_mm_))};
  }
  double cell_mm_;
  std::map<std::array<int, 3>, std::vector<Vector3d>> cells_;
};

}  // namespace

void claim_overhang(const ExportedPrinter& result, const TriangleMesh& outer_mesh, const Surface& outer,
                    Verdict* verdict) {
  const ExportedSupports& supports = *result.supports;
  const double h = result.skin_thickness_mm;
  const double steep = std::sin(supports.self_supporting_angle_deg * std::numbers::pi / 180);
  Held roofs_held(3.0), undersides_held(3.0);
  std::vector<Sample> roofs, undersides;
  for (const auto& t : outer_mesh.triangles) {
    const Vector3d &a = outer_mesh.vertices[t[0]], &b = outer_mesh.vertices[t[1]],
                   &c = outer_mesh.vertices[t[2]];
    const Vector3d cross = (b - a).cross(c - a);
    if (cross.norm() <= 0) continue;
    const Vector3d normal = cross.normalized();
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    const int n = std::clamp(static_cast<int>(std::ceil(longest / kSampleMm)), 1, kMostDivisions);
    const double flatness = std::abs(normal.z());
    const double degrees = std::asin(std::min(flatness, 1.0)) * 180 / std::numbers::pi;
    const double reach = 0.5 * printable_mm(supports.printable_length, degrees) + kToleranceMm;
    for (int i = 0; i < n; ++i)
      for (int j = 0; i + j < n; ++j) {
        const Vector3d p = a + (i + 1.0 / 3) / n * (b - a) + (j + 1.0 / 3) / n * (c - a);
        const double area = 0.5 * cross.norm() / (n * n) * (j + i + 1 < n ? 2 : 1);
        const Vector3d inner = p - h * normal;
        if (flatness <= steep) {
          roofs_held.add(inner);
          undersides_held.add(p);
        } else if (normal.z() < 0) {
          if (p.z() > supports.plate_z_mm + supports.plate_reach_mm)
            undersides.push_back({p, area, reach});
          else
            undersides_held.add(p);
        } else if (outer.depth_mm(inner - 0.3 * h * normal) > 1.1 * h) {  // there is a cavity below it
          roofs.push_back({inner, area, reach});
        } else {
          roofs_held.add(inner);
        }
      }
  }
  std::vector<Vector3d> nodes = result.frame.nodes_mm;
  for (const ExportedSupportNode& node : supports.nodes) nodes.push_back(node.at_mm);
  const auto add_holder = [&](int i, int j, Held& holds) {  // within M roofs, outside of it undersides
    const Vector3d d = nodes[i] - nodes[j];
    const double degrees = std::atan2(d.head<2>().norm(), std::abs(d.z())) * 180 / std::numbers::pi;
    if (degrees > supports.self_supporting_angle_deg + 1e-6) return;
    const Vector3d& top = d.z() > 0 ? nodes[i] : nodes[j];
    holds.add(top);
  };
  for (const ExportedStrut& s : result.frame.struts)
    if (!s.skin) add_holder(s.a, s.b, roofs_held);
  for (const ExportedSupportStrut& s : supports.struts)
    add_holder(s.upper, s.lower, s.external ? undersides_held : roofs_held);

  double flat = 0, beyond = 0;
  const auto count = [&](const std::vector<Sample>& samples, const Held& held) {
    for (const Sample& s : samples) {
      flat += s.area_mm2;
      if (!held.near(s.at, s.reach_mm)) beyond += s.area_mm2;
    }
  };
  count(roofs, roofs_held);
  count(undersides, undersides_held);
  const double reported = supports.roof_beyond_mm2 + supports.underside_beyond_mm2;
  const double share = supports.cavity_surface_mm2 > 0 ? reported / supports.cavity_surface_mm2 : 0;
  verdict->claims.push_back(
      {"overhanging skin",
       beyond <= reported + kToleranceShare * supports.cavity_surface_mm2 &&
           std::abs(share - supports.beyond_share) <= 1e-6 &&
           supports.cavity_surface_mm2 <= 1.1 * surface_area(outer_mesh),
       fmt::format(
           "{:.0f} mm2 of {:.0f} mm2 of flat skin hang further from what holds them than prints; reported "
           "{:.0f} mm2, {:.2f} % of the cavity's surface",
           beyond, flat, reported, 100 * supports.beyond_share)});
}

}  // namespace skinframe::check
