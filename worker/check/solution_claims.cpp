// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "worker/check/claims.h"

namespace skinframe::check {
namespace {

constexpr double kRadiusTolerance = 1e-6;  // relative
constexpr double kVolumeTolerance = 1e-6;  // relative
constexpr double kMarginToleranceMm = 1e-3;
// A strut thinner than this is absent, and so asks for no slenderness; the paper's zeta.
constexpr double kVanishedRadiusMm = 1e-5;

double length_mm(const ExportedFrame& frame, const ExportedStrut& s) {
  return (frame.nodes_mm[s.b] - frame.nodes_mm[s.a]).norm();
}

void claim_radii(const ExportedFrame& frame, Verdict* verdict) {
  double below = 0, above = 0, worst_slender = 0;
  int widened = 0;
  for (const ExportedStrut& s : frame.struts) {
    const double slender = frame.slenderness ? length_mm(frame, s) / *frame.slenderness : 0.0;
    // A strut too long for its upper bound takes the slender radius and 1 % of room above it.
    const bool is_widened = slender > s.max_radius_mm;
    widened += is_widened ? 1 : 0;
    const double upper = is_widened ? 1.01 * slender : s.max_radius_mm;
    below = std::max(below, (s.min_radius_mm - s.radius_mm) / s.max_radius_mm);
    above = std::max(above, (s.radius_mm - upper) / upper);
    if (s.radius_mm > kVanishedRadiusMm || s.min_radius_mm > 0)
      worst_slender = std::max(worst_slender, slender / s.radius_mm);
  }
  verdict->claims.push_back(
      {"radii", below <= kRadiusTolerance && above <= kRadiusTolerance,
       fmt::format("{} struts, each within its own bounds but for {:.1e} of them (at most {:.0e}), {} above "
                   "because slenderness asks for it",
                   frame.struts.size(), std::max(below, above), kRadiusTolerance, widened)});
  if (frame.slenderness)
    verdict->claims.push_back({"slenderness", worst_slender <= 1 + kRadiusTolerance,
                               fmt::format("worst l / (alpha r) is {:.6f}, at most 1", worst_slender)});
}

void claim_volumes(const ExportedPrinter& figures, Verdict* verdict) {
  const ExportedFrame& frame = figures.frame;
  double volume = 0;
  for (const ExportedStrut& s : frame.struts)
    volume += std::numbers::pi * s.radius_mm * s.radius_mm * length_mm(frame, s);
  const auto same = [&](double reported) {
    return std::abs(volume - reported) <= kVolumeTolerance * std::max(volume, reported);
  };
  verdict->claims.push_back(
      {"volume and counts",
       same(figures.frame_volume_mm3) && same(figures.geometry_volume_mm3) &&
           static_cast<int>(frame.nodes_mm.size()) == figures.final_nodes &&
           static_cast<int>(frame.struts.size()) == figures.final_struts,
       fmt::format("{} nodes, {} struts, {:.6g} mm3 (reported {}, {}, {:.6g})", frame.nodes_mm.size(),
                   frame.struts.size(), volume, figures.final_nodes, figures.final_struts,
                   figures.frame_volume_mm3)});
  if (figures.infeasible()) return;
  const double slack = 1 + kVolumeTolerance;
  verdict->claims.push_back(
      {"no volume rises from stage to stage",
       figures.topology_volume_mm3 <= figures.size_volume_mm3 * slack &&
           figures.geometry_volume_mm3 <= figures.topology_volume_mm3 * slack,
       fmt::format("size {:.6g}, topology {:.6g}, geometry {:.6g} mm3", figures.size_volume_mm3,
                   figures.topology_volume_mm3, figures.geometry_volume_mm3)});
}

void claim_balance_rows(const ExportedPrinter& figures, Verdict* verdict) {
  const ExportedFrame& frame = figures.frame;
  if (frame.balance_half_planes.empty() || figures.infeasible()) return;
  const Eigen::Vector2d centre = nominal_centre_of_gravity_mm(frame).head<2>();
  double margin = std::numeric_limits<double>::infinity();
  for (const auto& [normal, offset_mm] : frame.balance_half_planes)
    margin = std::min(margin, offset_mm - normal.dot(centre));
  verdict->claims.push_back(
      {"balance",
       margin >= -1e-6 && figures.balance_margin_mm &&
           std::abs(margin - *figures.balance_margin_mm) <= kMarginToleranceMm,
       fmt::format(
           "centre of gravity ({:.3f}, {:.3f}) mm is {:.4f} mm inside the {} half planes (reported {})",
           centre.x(), centre.y(), margin, frame.balance_half_planes.size(),
           figures.balance_margin_mm ? fmt::format("{:.4f}", *figures.balance_margin_mm) : "none")});
}

}  // namespace

void claim_solution(const ExportedPrinter& solution, Verdict* verdict) {
  claim_radii(solution.frame, verdict);
  claim_volumes(solution, verdict);
  claim_balance_rows(solution, verdict);
}

}  // namespace skinframe::check
