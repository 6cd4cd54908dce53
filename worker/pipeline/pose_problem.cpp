// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/pipeline/pose_problem.h"

#include <algorithm>

#include "worker/frame/convex_region.h"
#include "worker/frame/lump_skin.h"
#include "worker/pipeline/place_loads.h"

namespace skinframe {

std::vector<std::array<bool, 3>> hold_contact(const Frame& frame, const std::vector<int>& contact_nodes,
                                              Supports supports) {
  SKINFRAME_CHECK(contact_nodes.size() >= 3);
  std::vector<std::array<bool, 3>> fixed(frame.nodes_mm.size(), {false, false, false});
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const int i : contact_nodes) {
    fixed[i] = {supports == Supports::kPinned, supports == Supports::kPinned, true};
    middle += frame.nodes_mm[i] / static_cast<double>(contact_nodes.size());
  }
  if (supports == Supports::kPinned) return fixed;
  const auto furthest = [&](const Eigen::Vector3d& from, double sign) {
    int best = contact_nodes.front();
    double best_distance = -std::numeric_limits<double>::infinity();
    for (const int i : contact_nodes) {
      const double d = sign * (frame.nodes_mm[i] - from).head<2>().norm();
      if (d > best_distance) {
        best = i;
        best_distance = d;
      }
    }
    return best;
  };
  const int centre = furthest(middle, -1);  // the nearest
  const int rim = furthest(frame.nodes_mm[centre], +1);
  fixed[centre] = {true, true, true};
  // The axis across the line between the two stops the turning about z.
  const Eigen::Vector3d arm = frame.nodes_mm[rim] - frame.nodes_mm[centre];
  fixed[rim][std::abs(arm.x()) > std::abs(arm.y()) ? 1 : 0] = true;
  return fixed;
}

BalanceState decide_balance(BalanceMode mode, const Contact& contact) {
  switch (mode) {
    case BalanceMode::kOff:
      return BalanceState::kOff;
    case BalanceMode::kRequire:
      return BalanceState::kEnforced;
    case BalanceMode::kAuto:
      return contact.stands ? BalanceState::kEnforced : BalanceState::kNotStanding;
  }
  SKINFRAME_CHECK(false);
}

double balance_reserve_mm(const Contact& contact) {
  return std::clamp(0.5 * contact.margin_mm, 0.0, kBalanceReserveMm);
}

std::vector<HalfPlane> balance_half_planes(const Polygon2& whole_hull, double reserve_mm) {
  const Polygon2 hull = inscribed_polygon(whole_hull, kMaxBalanceEdges);
  std::vector<HalfPlane> planes;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Eigen::Vector2d edge = hull[(i + 1) % hull.size()] - hull[i];
    const Eigen::Vector2d normal =
        Eigen::Vector2d(edge.y(), -edge.x()).normalized();  // outward of a counter-clockwise hull
    planes.push_back({normal, normal.dot(hull[i]) - reserve_mm});
  }
  return planes;
}

Result<PosedProblem> pose_problem(const Solid& solid, const Contact& contact, const Skin& skin,
                                  const SampledFrame& sampled, const PrinterRequest& request,
                                  const std::vector<Load>& loads, const JobOptions& options) {
  FrameProblem problem;
  problem.element = ElementModel::kPaper;
  problem.material = request.material;
  problem.frame = sampled.frame;
  problem.displacement_limit_mm = options.displacement_limit_mm;
  const PrinterProfile& printer = request.printer;
  const std::vector<double> clearance_mm = strut_clearance_mm(sampled.frame, skin);
  for (std::size_t j = 0; j < sampled.frame.struts.size(); ++j) {
    // What would stand out of M1 is not printed, so it must not be counted on: (7) bounds the radius beside
    // (10).
    // So must what would stand in a drain hole.
    const Strut& strut = sampled.frame.struts[j];
    const double upper = strut.is_skin ? printer.skin_thickness_mm()
                                       : std::min({printer.max_internal_radius_mm, clearance_mm[j],
                                                   room_mm(sampled.openings, sampled.frame.nodes_mm[strut.a],
                                                           sampled.frame.nodes_mm[strut.b])});
    problem.bounds.push_back({printer.min_radius_mm, std::max(upper, printer.min_radius_mm)});
  }
  problem.fixed = hold_contact(sampled.frame, sampled.contact_nodes, Supports::kLeast);
  auto placed = place_loads(loads, solid, sampled.frame);
  if (!placed) return placed.error();
  problem.load_cases = std::move(placed.value().cases);
  const double weight_density = problem.material.weight_density_n_mm3();
  for (const double volume : lump_skin_volume_mm3(sampled.frame, skin))
    problem.skin_weight_n.push_back(volume * weight_density);
  problem.skin_mass = {skin.volume_mm3 * weight_density, skin.centroid_mm};
  if (decide_balance(options.balance, contact) == BalanceState::kEnforced)
    problem.balance = balance_half_planes(contact.hull, balance_reserve_mm(contact));
  problem.free_nodes.assign(sampled.frame.nodes_mm.size(), false);
  for (std::size_t i = sampled.frame.skin_node_count; i < problem.free_nodes.size(); ++i)
    problem.free_nodes[i] = true;
  // Struts beside a drain hole stay where they are, clear of it.
  for (const Strut& strut : sampled.frame.struts)
    if (!strut.is_skin && room_mm(sampled.openings, sampled.frame.nodes_mm[strut.a],
                                  sampled.frame.nodes_mm[strut.b]) < printer.max_internal_radius_mm)
      problem.free_nodes[strut.a] = problem.free_nodes[strut.b] = false;
  if (auto valid = validate(problem); !valid) return valid.error();
  return PosedProblem{std::move(problem), std::move(placed.value().warnings)};
}

}  // namespace skinframe
