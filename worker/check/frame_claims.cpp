// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include "worker/check/claims.h"

namespace skinframe::check {
namespace {

// The axis of an internal strut leaves a skin node at this slope at least: only beyond r / slope from it the
// strut has to be clear of the skin by its radius.
constexpr double kLeavingSlope = 0.2;

double length_mm(const ExportedFrame& frame, const ExportedStrut& s) {
  return (frame.nodes_mm[s.b] - frame.nodes_mm[s.a]).norm();
}

void claim_radii(const ExportedPrinter& result, Verdict* verdict) {
  const ExportedFrame& frame = result.frame;
  double thinnest = std::numeric_limits<double>::infinity(), worst_excess = 0, worst_slender = 0;
  int widened = 0;
  for (const ExportedStrut& s : frame.struts) {
    const double slender = frame.slenderness ? length_mm(frame, s) / *frame.slenderness : 0.0;
    // A strut too long for its upper bound takes the slender radius and 1 % of room above it.
    const double bound = s.skin ? result.skin_thickness_mm : result.max_internal_radius_mm;
    const double upper = std::max(bound, 1.01 * slender);
    if (s.radius_mm > bound * (1 + 1e-6)) ++widened;
    thinnest = std::min(thinnest, s.radius_mm);
    worst_excess = std::max(worst_excess, s.radius_mm / upper);
    worst_slender = std::max(worst_slender, slender / s.radius_mm);
  }
  const bool radii = thinnest >= result.eta_mm * (1 - 1e-6) && worst_excess <= 1 + 1e-6 &&
                     std::abs(thinnest - result.min_radius_mm) <= 1e-6;
  verdict->claims.push_back(
      {"radii", radii,
       fmt::format("thinnest {:.4f} mm (at least {:.4f}), thickest {:.4f} of its upper bound, {} of "
                   "{} struts above it because slenderness asks for it",
                   thinnest, result.eta_mm, worst_excess, widened, frame.struts.size())});
  verdict->claims.push_back({"slenderness", worst_slender <= 1 + 1e-6,
                             fmt::format("worst l / (alpha r) is {:.6f}, at most 1", worst_slender)});
}

// At the rim of a drain hole the triangulation ends; also where the hole could not be cut then.
bool at_a_rim(const ExportedPrinter& result, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  if (!result.drain) return false;
  const auto is_near = [&](const std::vector<ExportedHole>& holes, const Eigen::Vector3d& p) {
    const BesideHole near = nearest_hole(holes, p);
    if (near.hole < 0) return false;
    const double radius = 0.5 * holes[near.hole].diameter_mm;
    return near.beside_mm >= radius && near.beside_mm <= 1.1 * (radius + 2.0 * result.skin_thickness_mm);
  };
  return (is_near(result.drain->holes, a) && is_near(result.drain->holes, b)) ||
         (is_near(result.drain->uncut, a) && is_near(result.drain->uncut, b));
}

void claim_triangulation(const ExportedPrinter& result, Verdict* verdict) {
  const ExportedFrame& frame = result.frame;
  std::map<std::pair<int, int>, int> directed;
  std::set<std::pair<int, int>> edges;
  std::set<int> nodes;
  for (const auto& t : frame.skin_triangles)
    for (int k = 0; k < 3; ++k) {
      const int a = t[k], b = t[(k + 1) % 3];
      ++directed[{a, b}];
      edges.insert({std::min(a, b), std::max(a, b)});
      nodes.insert(a);
    }
  std::size_t open = 0, rim = 0;
  for (const auto& [edge, uses] : directed) {
    const auto opposite = directed.find({edge.second, edge.first});
    if (uses == 1 && opposite == directed.end() &&
        at_a_rim(result, frame.nodes_mm[edge.first], frame.nodes_mm[edge.second])) {
      ++rim;
      continue;
    }
    if (uses != 1 || opposite == directed.end() || opposite->second != 1) ++open;
  }
  std::size_t missing = edges.size();
  std::size_t skin_struts = 0;
  for (const ExportedStrut& s : frame.struts) {
    if (!s.skin) continue;
    ++skin_struts;
    missing -= edges.count({std::min(s.a, s.b), std::max(s.a, s.b)});
  }
  verdict->claims.push_back(
      {"skin triangulation", !edges.empty() && open == 0 && missing == 0 && skin_struts == edges.size(),
       fmt::format("{} nodes, {} edges, {} triangles, Euler characteristic {}; {} directed edges not "
                   "matched once beside {} at drain holes, {} edges without a strut",
                   nodes.size(), edges.size(), frame.skin_triangles.size(),
                   static_cast<long>(nodes.size()) - static_cast<long>(edges.size()) +
                       static_cast<long>(frame.skin_triangles.size()),
                   open, rim, missing)});
}

void claim_connected(const ExportedFrame& frame, Verdict* verdict) {
  std::vector<std::vector<int>> neighbours(frame.nodes_mm.size());
  for (const ExportedStrut& s : frame.struts) {
    neighbours[s.a].push_back(s.b);
    neighbours[s.b].push_back(s.a);
  }
  std::vector<bool> reached(frame.nodes_mm.size(), false);
  std::vector<int> stack;
  for (std::size_t i = 0; i < frame.fixed.size(); ++i)
    if (frame.fixed[i][2] && !reached[i]) {
      reached[i] = true;
      stack.push_back(static_cast<int>(i));
    }
  while (!stack.empty()) {
    const int node = stack.back();
    stack.pop_back();
    for (const int next : neighbours[node])
      if (!reached[next]) {
        reached[next] = true;
        stack.push_back(next);
      }
  }
  std::size_t lost = 0;
  for (const bool r : reached) lost += r ? 0 : 1;
  verdict->claims.push_back(
      {"every node stands on the base", lost == 0,
       fmt::format("{} of {} nodes have no path of struts to a support", lost, reached.size())});
}

void claim_volumes(const ExportedPrinter& result, Verdict* verdict) {
  double volume = 0;
  for (const ExportedStrut& s : result.frame.struts)
    volume += std::numbers::pi * s.radius_mm * s.radius_mm * length_mm(result.frame, s);
  const double total = volume + result.skin_volume_mm3;
  const double relative = std::abs(volume - result.frame_volume_mm3) / volume;
  verdict->claims.push_back(
      {"nominal volumes",
       relative <= 1e-6 && std::abs(total - result.total_volume_mm3) <= 1e-6 * total &&
           std::abs(total / result.solid_volume_mm3 - result.ratio) <= 1e-6 &&
           static_cast<int>(result.frame.nodes_mm.size()) == result.final_nodes &&
           static_cast<int>(result.frame.struts.size()) == result.final_struts,
       fmt::format(
           "{} nodes, {} struts, frame {:.1f} mm3 (reported {}, {}, {:.1f}), total {:.1f} mm3, ratio {:.4f} "
           "(reported {:.1f}, {:.4f})",
           result.frame.nodes_mm.size(), result.frame.struts.size(), volume, result.final_nodes,
           result.final_struts, result.frame_volume_mm3, total, total / result.solid_volume_mm3,
           result.total_volume_mm3, result.ratio)});
  if (!result.optimised() || result.infeasible()) return;
  const double slack = 1 + 1e-6;
  verdict->claims.push_back(
      {"no volume rises from stage to stage",
       result.topology_volume_mm3 <= result.size_volume_mm3 * slack &&
           result.geometry_volume_mm3 <= result.topology_volume_mm3 * slack &&
           std::abs(result.geometry_volume_mm3 - result.frame_volume_mm3) <= 1e-6 * result.frame_volume_mm3,
       fmt::format("size {:.1f}, topology {:.1f}, geometry {:.1f} mm3", result.size_volume_mm3,
                   result.topology_volume_mm3, result.geometry_volume_mm3)});
}

void claim_inside(const ExportedPrinter& result, const Surface& outer, Verdict* verdict) {
  const ExportedFrame& frame = result.frame;
  // The sampling grid of M1 is about 1 mm wide at 200 mm; the surface stands within a fraction of it.
  const double tolerance = 0.25 * result.skin_thickness_mm;
  // On large bodies the grid is as wide as the skin, and what is read off it a third of that.
  const double clearance_tolerance = 0.4 * result.skin_thickness_mm;
  std::vector<bool> is_skin(frame.nodes_mm.size(), false);
  for (const auto& t : frame.skin_triangles)
    for (const int v : t) is_skin[v] = true;
  double worst_internal = std::numeric_limits<double>::infinity(), worst_bridge = worst_internal;
  double worst_clearance = worst_internal;  // of a strut with its radius, against M1
  std::size_t internal = 0, bridges = 0, skin = 0;
  int leaving = 0;
  double furthest_out = 0;
  for (const ExportedStrut& s : frame.struts) {
    const Eigen::Vector3d &a = frame.nodes_mm[s.a], &b = frame.nodes_mm[s.b];
    const int steps = s.skin ? 4 : std::max(4, static_cast<int>(std::ceil((b - a).norm())));
    double least = std::numeric_limits<double>::infinity();
    double clearance = least;
    for (int k = 0; k <= steps; ++k) {
      const double t = double(k) / steps, depth = outer.depth_mm(a + (b - a) * t);
      least = std::min(least, depth);
      // Where it grows out of the skin a strut cannot be clear of it.
      double from_skin = std::numeric_limits<double>::infinity();
      if (is_skin[s.a]) from_skin = std::min(from_skin, t * (b - a).norm());
      if (is_skin[s.b]) from_skin = std::min(from_skin, (1 - t) * (b - a).norm());
      clearance = std::min(
          clearance, depth - result.skin_thickness_mm - std::min(s.radius_mm, kLeavingSlope * from_skin));
    }
    if (s.skin) {
      ++skin;
      if (least < -tolerance) ++leaving;
      furthest_out = std::max(furthest_out, -least);
    } else if (is_skin[s.a] && is_skin[s.b]) {
      ++bridges;
      worst_bridge = std::min(worst_bridge, least);
    } else {
      ++internal;
      worst_internal = std::min(worst_internal, least);
      worst_clearance = std::min(worst_clearance, clearance);
    }
  }
  const double wanted = result.skin_thickness_mm - tolerance;
  verdict->claims.push_back(
      {"internal struts inside the skin",
       (internal == 0 || (worst_internal >= wanted && worst_clearance >= -clearance_tolerance)) &&
           (bridges == 0 || worst_bridge > 0),
       internal + bridges == 0
           ? std::string("there are none")
           : fmt::format(
                 "{} struts, the shallowest axis {:.3f} mm below the surface (at least {:.3f}), the least "
                 "clearance of a strut's own radius from the skin's inside {:.3f} mm (at least {:.3f}); {} "
                 "struts between skin nodes{}",
                 internal, internal == 0 ? 0.0 : worst_internal, wanted,
                 internal == 0 ? 0.0 : worst_clearance, -clearance_tolerance, bridges,
                 bridges == 0 ? "" : fmt::format(", shallowest {:.3f} mm (more than 0)", worst_bridge))});
  const std::string followed = fmt::format(
      "{} of {} skin struts leave the object between their nodes by more than {:.2f} mm{}, by {:.2f} "
      "mm at most; what leaves is not printed",
      leaving, skin, tolerance,
      result.skin_struts_outside ? fmt::format(" (reported {})", *result.skin_struts_outside) : "",
      furthest_out);
  if (result.skin_struts_outside)
    verdict->claims.push_back(
        {"skin struts follow the skin", leaving <= *result.skin_struts_outside, followed});
  else
    verdict->notes.push_back(followed);
}

}  // namespace

void claim_frame(const ExportedPrinter& result, const Surface* outer, Verdict* verdict) {
  claim_radii(result, verdict);
  claim_triangulation(result, verdict);
  claim_connected(result.frame, verdict);
  claim_volumes(result, verdict);
  if (outer != nullptr) claim_inside(result, *outer, verdict);
}

}  // namespace skinframe::check
