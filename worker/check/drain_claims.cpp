// SPDX-License-Identifier: GPL-3.0-or-later
// Drain holes: that they are there and as wide as reported, that nothing stands in them, that all void but
// what is named can be emptied through them, and that the caps fit. By lines through the holes, by the
// frame's struts, by a flood through columns, by the caps' corners.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "worker/check/claims.h"
#include "worker/check/near_boxes.h"
#include "worker/check/void_columns.h"

namespace skinframe::check {
namespace {

constexpr int kDirections = 24;
constexpr double kColumnInSkins = 0.45;  // of the skin's thickness: no wall is overlooked
constexpr double kNarrowestInSkins = 0.08;
constexpr double kNarrower = 0.7;  // from one flood to the next
constexpr double kMostColumns = 4e6;
constexpr double kStrayShare = 2e-5;  // of the void, in columns that graze a wall
constexpr double kOfHollow = 0.02;    // of what is named: its volume by columns
constexpr double kRoundingMm = 5e-3;

struct Line {
  Eigen::Vector3d from, to;
  std::vector<double> crossed_mm;  // from its beginning, ascending
};

// Parallel to the axis, from outside of the hole to within the cavity.
std::vector<Line> lines_through(const ExportedHole& hole, const std::vector<double>& radii_mm) {
  const Eigen::Vector3d u = hole.axis.unitOrthogonal(), v = hole.axis.cross(u);
  std::vector<Line> lines;
  for (const double radius : radii_mm)
    for (int i = 0; i < (radius > 0 ? kDirections : 1); ++i) {
      const double angle = 2 * std::numbers::pi * (i + 0.37) / kDirections;
      const Eigen::Vector3d at = hole.centre_mm + radius * (std::cos(angle) * u + std::sin(angle) * v);
      lines.push_back({at + hole.rise_mm * hole.axis, at - hole.clear_mm * hole.axis});
    }
  return lines;
}

std::optional<double> crossing_mm(const Line& line, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                  const Eigen::Vector3d& c) {
  const Eigen::Vector3d along = line.to - line.from, u = b - a, v = c - a, p = along.cross(v);
  const double determinant = u.dot(p);
  if (determinant == 0.0) return std::nullopt;
  const Eigen::Vector3d s = line.from - a, q = s.cross(u);
  const double x = s.dot(p) / determinant, y = along.dot(q) / determinant, w = v.dot(q) / determinant;
  if (x < 0.0 || y < 0.0 || x + y > 1.0 || w < 0.0 || w > 1.0) return std::nullopt;
  return w * along.norm();
}

void find_crossed(const TriangleMesh& mesh, std::vector<Line>& lines) {
  std::vector<Eigen::AlignedBox3d> boxes;
  for (const Line& line : lines) boxes.emplace_back(line.from.cwiseMin(line.to), line.from.cwiseMax(line.to));
  for (const auto& [a, b, c] : mesh.triangles) {
    const auto &p = mesh.vertices[a], &q = mesh.vertices[b], &r = mesh.vertices[c];
    boxes.emplace_back(p.cwiseMin(q).cwiseMin(r), p.cwiseMax(q).cwiseMax(r));
  }
  const int count = static_cast<int>(lines.size());
  for_each_overlap(boxes, [&](int i, int j) {
    if (i >= count || j < count) return;
    const auto& [a, b, c] = mesh.triangles[j - count];
    const auto at = crossing_mm(lines[i], mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]);
    if (at) lines[i].crossed_mm.push_back(*at);
  });
  for (Line& line : lines) std::sort(line.crossed_mm.begin(), line.crossed_mm.end());
}

// Into the surface and as much further on as the skin is thick; where a strut stands beside the hole, the
// line ends within it.
bool finds_skin(const Line& line, double thickness_mm) {
  if (line.crossed_mm.empty()) return false;
  const double out = line.crossed_mm.size() > 1 ? line.crossed_mm[1] : (line.to - line.from).norm();
  return out - line.crossed_mm[0] >= thickness_mm;
}

void claim_holes(const ExportedPrinter& result, const Surface& outer, const Surface& hollow,
                 Verdict* verdict) {
  const ExportedDrain& drain = *result.drain;
  int blocked = 0, wider = 0, astray = 0, looked = 0;
  for (const ExportedHole& hole : drain.holes) {
    const double radius = 0.5 * hole.diameter_mm, voxel = result.voxel_mm;
    std::vector<Line> within = lines_through(hole, {0, 0.3 * radius, 0.7 * radius, radius - voxel});
    std::vector<Line> beside = lines_through(hole, {radius + voxel});
    find_crossed(*result.merged, within);
    find_crossed(*result.merged, beside);
    for (const Line& line : within) {
      ++looked;
      blocked += !line.crossed_mm.empty();
      astray += outer.depth_mm(line.from) > 0 || hollow.depth_mm(line.to) <= 0 ||
                outer.depth_mm(line.to) < result.skin_thickness_mm - voxel;
    }
    for (const Line& line : beside) wider += !finds_skin(line, result.skin_thickness_mm - voxel);
  }
  verdict->claims.push_back(
      {"drain holes are open and as wide as reported", blocked + wider + astray == 0,
       fmt::format(
           "{} holes of {} reported by the rule ({:g} mm); of {} lines through them {} are blocked "
           "and {} do not lead from outside into the cavity; {} beside them by a voxel do not find the skin",
           drain.holes.size(), drain.rule_least_count, drain.rule_diameter_mm, looked, blocked, astray,
           wider)});
}

// Where a hole is told of that could not be cut, each line meets the skin.
void claim_closed(const ExportedPrinter& result, Verdict* verdict) {
  const ExportedDrain& drain = *result.drain;
  if (drain.uncut.empty()) return;
  int open = 0;
  for (const ExportedHole& hole : drain.uncut) {
    const double radius = 0.5 * hole.diameter_mm;
    std::vector<Line> within = lines_through(hole, {0, 0.5 * radius, radius - result.voxel_mm});
    find_crossed(*result.merged, within);
    for (const Line& line : within) open += !finds_skin(line, result.skin_thickness_mm - result.voxel_mm);
  }
  verdict->claims.push_back(
      {"drain holes that are reported as not cut are closed", open == 0,
       fmt::format("{} lines through {} of them do not find the skin", open, drain.uncut.size())});
}

void claim_free_of_struts(const ExportedPrinter& result, Verdict* verdict) {
  const ExportedDrain& drain = *result.drain;
  int within = 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (const ExportedStrut& s : result.frame.struts) {
    const Eigen::Vector3d &a = result.frame.nodes_mm[s.a], &b = result.frame.nodes_mm[s.b];
    const int steps = 1 + static_cast<int>((b - a).norm() / 0.2);
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= steps; ++i) {
      const Eigen::Vector3d p = a + (b - a) * (static_cast<double>(i) / steps);
      for (const ExportedHole& hole : drain.holes) {
        const Eigen::Vector3d from = p - hole.centre_mm;
        const double along = from.dot(hole.axis);
        const double beside = std::max((from - along * hole.axis).norm() - 0.5 * hole.diameter_mm, 0.0);
        least = std::min(least,
                         std::hypot(beside, std::max({along - hole.rise_mm, -hole.clear_mm - along, 0.0})));
      }
    }
    within += least < s.radius_mm - 0.5 * result.voxel_mm;
    nearest = std::min(nearest, least - s.radius_mm);
  }
  verdict->claims.push_back({"no strut stands in a drain hole", within == 0,
                             drain.holes.empty()
                                 ? std::string("there are none")
                                 : fmt::format("{} of {} struts do; the nearest keeps {:.3f} mm off", within,
                                               result.frame.struts.size(), nearest)});
}

// What is sealed by columns hangs on by passages narrower than they are apart, or is sealed: narrower columns
// tell. A hollow that is not named stays sealed however narrow they are, one that is named but open does not.
void claim_reachable(const ExportedPrinter& result, Verdict* verdict) {
  const ExportedDrain& drain = *result.drain;
  const BoundingBox box = bounding_box(*result.merged);
  const double least = std::max(std::sqrt(box.extent().x() * box.extent().y() / kMostColumns),
                                kNarrowestInSkins * result.skin_thickness_mm);
  double reported = 0;
  for (const ExportedVoid& sealed : drain.sealed) reported += sealed.volume_mm3;
  const double void_mm3 = result.solid_volume_mm3 - result.printed_volume_mm3;
  const double allowed = kStrayShare * void_mm3 + kOfHollow * reported;
  double spacing = std::max(least, kColumnInSkins * result.skin_thickness_mm);
  const double first_spacing = spacing;
  VoidVolumes volumes = flood_void(*result.merged, spacing);
  const double first_mm3 = volumes.sealed_mm3;
  const auto agree = [&] { return std::abs(volumes.sealed_mm3 - reported) <= allowed; };
  while (!agree() && spacing > least) {
    spacing = std::max(least, kNarrower * spacing);
    volumes = flood_void(*result.merged, spacing);
  }
  std::string largest;
  if (!agree() && !volumes.sealed.empty()) {
    const Eigen::Vector3d& at = volumes.sealed[0].centre_mm;
    largest = fmt::format("; the largest, {:.1f} mm3, about ({:.1f}, {:.1f}, {:.1f}) mm",
                          volumes.sealed[0].volume_mm3, at.x(), at.y(), at.z());
  }
  verdict->claims.push_back(
      {"all void is reached through the drain holes but what is named",
       agree() && volumes.torn * 1000 <= volumes.columns,
       fmt::format("{:.1f} mm3 of {:.0f} mm3 have no way out by {} columns of {:.2f} mm ({} not clear){}; "
                   "reported {:.1f} mm3 in {} hollows (+- {:.1f})",
                   volumes.sealed_mm3, void_mm3, volumes.columns, spacing, volumes.torn, largest, reported,
                   drain.sealed.size(), allowed)});
  if (spacing < first_spacing && first_mm3 - volumes.sealed_mm3 > allowed)
    verdict->notes.push_back(
        fmt::format("{:.1f} mm3 of the void hang on by passages narrower than {:.2f} mm only",
                    first_mm3 - volumes.sealed_mm3, first_spacing));
}

void claim_caps(const ExportedPrinter& result, const Surface& outer, Verdict* verdict) {
  const ExportedDrain& drain = *result.drain;
  if (drain.caps == 0 && drain.caps_mesh.triangles.empty()) return;
  const EdgeCount edges = count_edges(drain.caps_mesh);
  std::vector<double> widest(drain.holes.size(), 0.0);
  double proud = 0, deepest = 0;
  for (const Eigen::Vector3d& p : drain.caps_mesh.vertices) {
    const BesideHole near = nearest_hole(drain.holes, p);
    if (near.hole < 0) continue;
    widest[near.hole] = std::max(widest[near.hole], near.beside_mm);
    const double depth = outer.depth_mm(p);
    proud = std::max(proud, -depth);
    deepest = std::max(deepest, depth);
  }
  int fitting = 0, present = 0;
  double tightest = std::numeric_limits<double>::infinity(), loosest = 0;
  for (std::size_t k = 0; k < widest.size(); ++k) {
    if (widest[k] == 0.0) continue;
    ++present;
    const double gap = 0.5 * drain.holes[k].diameter_mm - widest[k];
    tightest = std::min(tightest, gap);
    loosest = std::max(loosest, gap);
    fitting += std::abs(gap - drain.cap_clearance_mm) <= kRoundingMm + 0.002 * drain.holes[k].diameter_mm;
  }
  verdict->claims.push_back(
      {"caps fit their holes",
       edges.unmatched + edges.crowded + edges.degenerate == 0 && present == drain.caps &&
           fitting == drain.caps && drain.cap_clearance_mm > 0 && proud <= kRoundingMm &&
           deepest <= drain.cap_thickness_mm + kRoundingMm && signed_volume(drain.caps_mesh) > 0,
       fmt::format(
           "{} caps of {} reported, {} with the clearance of {:.3f} mm ({:.3f} .. {:.3f}); they stand "
           "{:.3f} mm out of the surface and {:.3f} mm into it at most ({:.3f} mm thick); {} open edges",
           present, drain.caps, fitting, drain.cap_clearance_mm, present == 0 ? 0.0 : tightest, loosest,
           proud, deepest, drain.cap_thickness_mm, edges.unmatched + edges.crowded + edges.degenerate)});
}

}  // namespace

void claim_drain(const ExportedPrinter& result, const TriangleMesh& outer_mesh, const TriangleMesh& cavity,
                 const Surface& outer, Verdict* verdict) {
  if (!result.drain) return;
  const EdgeCount edges = count_edges(outer_mesh);
  verdict->claims.push_back(
      {"lids close the surface", edges.unmatched == 0,
       fmt::format("{} edges without their opposite in the first {} triangles with the {} of hole-lids.stl",
                   edges.unmatched, result.solid_triangles, result.drain->lids_mesh.triangles.size())});
  if (!cavity.triangles.empty()) {
    TriangleMesh outward = cavity;
    for (auto& t : outward.triangles) std::swap(t[1], t[2]);
    const Surface hollow(outward);
    claim_holes(result, outer, hollow, verdict);
    claim_closed(result, verdict);
  }
  claim_free_of_struts(result, verdict);
  claim_reachable(result, verdict);
  claim_caps(result, outer, verdict);
}

}  // namespace skinframe::check
