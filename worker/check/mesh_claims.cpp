// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <random>
#include <unordered_map>

#include "worker/check/claims.h"

namespace skinframe::check {
namespace {

TriangleMesh slice(const TriangleMesh& mesh, std::size_t first, std::size_t last) {
  TriangleMesh part{mesh.vertices, {}};
  part.triangles.assign(mesh.triangles.begin() + first, mesh.triangles.begin() + last);
  return weld_equal([&] {  // drops vertices that the part does not use
    TriangleMesh soup;
    for (const auto& t : part.triangles) {
      const int base = static_cast<int>(soup.vertices.size());
      for (const int v : t) soup.vertices.push_back(part.vertices[v]);
      soup.triangles.push_back({base, base + 1, base + 2});
    }
    return soup;
  }());
}

bool near(double measured, double reported, double relative) {
  return std::abs(measured - reported) <= relative * std::max(std::abs(measured), std::abs(reported));
}

}  // namespace

WallSample sample_wall(const Surface& outer, const BoundingBox& box, double depth_mm,
                       double solid_volume_mm3) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  constexpr int kInside = 20000, kTries = 2000000;
  int inside = 0, skin = 0;
  for (int i = 0; i < kTries && inside < kInside; ++i) {
    const Eigen::Vector3d u(unit(random), unit(random), unit(random));
    const double at = outer.depth_mm(box.min + u.cwiseProduct(box.extent()));
    if (at <= 0) continue;
    ++inside;
    if (at < depth_mm) ++skin;
  }
  if (inside == 0) return {0, solid_volume_mm3};
  const double share = static_cast<double>(skin) / inside;
  return {share * solid_volume_mm3, 4 * std::sqrt(share * (1 - share) / inside) * solid_volume_mm3};
}

EdgeCount count_edges(const TriangleMesh& mesh) {
  EdgeCount count;
  struct Uses {
    int along = 0, against = 0;
  };
  std::unordered_map<std::uint64_t, Uses> edges;
  edges.reserve(mesh.triangles.size() * 3 / 2);
  for (const auto& t : mesh.triangles) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) ++count.degenerate;
    for (int k = 0; k < 3; ++k) {
      const auto from = static_cast<std::uint32_t>(t[k]), to = static_cast<std::uint32_t>(t[(k + 1) % 3]);
      Uses& uses = edges[std::uint64_t{std::min(from, to)} << 32 | std::max(from, to)];
      (from < to ? uses.along : uses.against)++;
    }
  }
  for (const auto& [key, uses] : edges) {
    if (uses.along != uses.against) ++count.unmatched;
    if (uses.along + uses.against > 2) ++count.crowded;
  }
  return count;
}

void split_surfaces(const ExportedPrinter& result, TriangleMesh* outer, TriangleMesh* cavity) {
  const TriangleMesh& merged = *result.merged;
  const std::size_t split = std::min(result.solid_triangles, merged.triangles.size());
  *outer = slice(merged, 0, split);
  *cavity = slice(merged, split, merged.triangles.size());
  if (!result.drain || result.drain->lids_mesh.triangles.empty()) return;
  const TriangleMesh& lids = result.drain->lids_mesh;
  for (TriangleMesh* side : {outer, cavity}) {
    const int first = static_cast<int>(side->vertices.size());
    side->vertices.insert(side->vertices.end(), lids.vertices.begin(), lids.vertices.end());
    for (const auto& [a, b, c] : lids.triangles)
      side->triangles.push_back(side == outer ? std::array{first + a, first + b, first + c}
                                              : std::array{first + a, first + c, first + b});
    *side = weld_equal(*side);
  }
}

void claim_mesh(const ExportedPrinter& result, const TriangleMesh& outer_mesh, const TriangleMesh& cavity,
                const Surface& outer, Verdict* verdict) {
  const TriangleMesh& merged = *result.merged;
  const EdgeCount edges = count_edges(merged);
  verdict->claims.push_back(
      {"watertight", !merged.triangles.empty() && edges.unmatched + edges.crowded + edges.degenerate == 0,
       fmt::format("{} triangles, {} edges without their opposite, {} with more than two triangles, {} "
                   "collapsed triangles",
                   merged.triangles.size(), edges.unmatched, edges.crowded, edges.degenerate)});

  const double solid = signed_volume(outer_mesh);
  verdict->claims.push_back(
      {"outer surface is the solid", near(solid, result.solid_volume_mm3, 1e-4),
       fmt::format("{:.1f} mm3 inside the first {} triangles, reported solid {:.1f} mm3", solid,
                   outer_mesh.triangles.size(), result.solid_volume_mm3)});

  const double printed = signed_volume(merged);
  verdict->claims.push_back(
      {"printed volume", near(printed, result.printed_volume_mm3, 1e-4) && printed > 0,
       fmt::format("{:.1f} mm3, reported {:.1f} mm3", printed, result.printed_volume_mm3)});
  const double ratio = printed / solid;
  const double weight_g = printed * result.density_g_cm3 * 1e-3;
  verdict->claims.push_back({"printed ratio and weight",
                             near(ratio, result.printed_ratio, 1e-3) &&
                                 near(weight_g, result.weight_g, 1e-3) && ratio <= 1.0 + 1e-9,
                             fmt::format("{:.4f} and {:.3f} g, reported {:.4f} and {:.3f} g", ratio, weight_g,
                                         result.printed_ratio, result.weight_g)});

  // The cavity is where M is deeper than the skin; the level set is exact to a fraction of its voxel.
  double shallowest = std::numeric_limits<double>::infinity();
  bool outside = false;
  for (std::size_t i = 0; i < cavity.vertices.size(); ++i) {
    if (result.drain && in_a_hole(*result.drain, cavity.vertices[i])) continue;
    const double depth =
        i % 16 == 0 ? outer.depth_mm(cavity.vertices[i]) : outer.distance_mm(cavity.vertices[i]);
    outside |= depth < 0;
    shallowest = std::min(shallowest, depth);
  }
  const double least = result.skin_thickness_mm - 0.5 * result.voxel_mm;
  if (cavity.triangles.empty()) {
    verdict->notes.push_back("the result has no cavity: it is solid");
  } else {
    verdict->claims.push_back(
        {"skin thickness", !outside && shallowest >= least,
         fmt::format("the cavity's nearest point is {:.3f} mm below the surface, at least {:.3f} mm "
                     "(skin {:.3f} mm less half a voxel of {:.3f} mm)",
                     shallowest, least, result.skin_thickness_mm, result.voxel_mm)});
  }

  const BoundingBox box = bounding_box(outer_mesh);
  if (!result.solid() && !result.added_skin_mm3) {
    const WallSample skin = sample_wall(outer, box, result.skin_thickness_mm, solid);
    const double allowed = skin.error_mm3 + 0.02 * skin.volume_mm3;
    verdict->claims.push_back({"skin volume", std::abs(skin.volume_mm3 - result.skin_volume_mm3) <= allowed,
                               fmt::format("{:.0f} mm3 by sampling (+- {:.0f}), reported {:.0f} mm3",
                                           skin.volume_mm3, allowed, result.skin_volume_mm3)});
  }

  const Eigen::Vector3d extent = box.extent();
  const Eigen::Vector3d tray = result.tray_mm;
  const bool upright = extent.z() <= tray.z() + 1e-6;
  const bool fits = upright && ((extent.x() <= tray.x() + 1e-6 && extent.y() <= tray.y() + 1e-6) ||
                                (extent.y() <= tray.x() + 1e-6 && extent.x() <= tray.y() + 1e-6));
  verdict->claims.push_back({"fits the tray", fits,
                             fmt::format("{:.1f} x {:.1f} x {:.1f} mm on a tray of {:g} x {:g} x {:g} mm",
                                         extent.x(), extent.y(), extent.z(), tray.x(), tray.y(), tray.z())});
}

void claim_solid(const ExportedPrinter& result, const TriangleMesh& outer_mesh, const Surface& outer,
                 Verdict* verdict) {
  const double solid = signed_volume(outer_mesh);
  verdict->claims.push_back(
      {"solid throughout",
       near(result.printed_ratio, 1.0, 1e-6) && near(result.ratio, 1.0, 1e-6) &&
           near(result.total_volume_mm3, solid, 1e-4) && result.frame_volume_mm3 == 0.0 &&
           result.final_nodes == 0 && result.final_struts == 0 &&
           result.merged->triangles.size() == outer_mesh.triangles.size(),
       fmt::format(
           "{} triangles, {} of them the input's; total {:.1f} of {:.1f} mm3; {} nodes, {} struts reported",
           result.merged->triangles.size(), outer_mesh.triangles.size(), result.total_volume_mm3, solid,
           result.final_nodes, result.final_struts)});
  // A hollow is cut from a grid: a slit thinner than its voxel is none.
  const double deepest_mm = result.skin_thickness_mm + 0.5 * result.voxel_mm;
  const WallSample skin = sample_wall(outer, bounding_box(outer_mesh), deepest_mm, solid);
  const double deep = 1.0 - skin.volume_mm3 / solid;
  constexpr double kMostHollow = 0.015;  // of the volume; a body is called thin everywhere below 0.01
  verdict->claims.push_back(
      {"thin everywhere", deep <= kMostHollow + skin.error_mm3 / solid,
       fmt::format(
           "{:.4f} of the volume lies deeper than the skin of {:.3g} mm and half a voxel of {:.2g} mm "
           "(at most {})",
           deep, result.skin_thickness_mm, result.voxel_mm, kMostHollow)});
}

}  // namespace skinframe::check
