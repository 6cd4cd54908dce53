// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "worker/check/claims.h"

namespace skinframe::check {
namespace {

constexpr double kSameVolume = 1e-6;  // relative: the same floats, summed in another order
constexpr std::size_t kMostProbes = 50'000;

double greatest_distance(const TriangleMesh& from, const Surface& to) {
  const std::size_t stride = 1 + from.vertices.size() / kMostProbes;
  double furthest = 0;
  for (std::size_t v = 0; v < from.vertices.size(); v += stride)
    furthest = std::max(furthest, to.distance_mm(from.vertices[v]));
  return furthest;
}

}  // namespace

void claim_package(const ExportedPrinter& result, Verdict* verdict) {
  if (!result.package) return;
  const Package& package = *result.package;
  const double volume = signed_volume(package.mesh), printed = signed_volume(*result.merged);
  verdict->claims.push_back(
      {"skin-frame.3mf is the mesh",
       package.unit == "millimeter" && package.required_extensions.empty() && !package.object_name.empty() &&
           package.mesh.triangles.size() == result.merged->triangles.size() &&
           std::abs(volume - printed) <= kSameVolume * std::abs(printed),
       fmt::format("object \"{}\" in {}, {} triangles ({} in skin-frame.stl), {:.3f} mm3 ({:.3f})",
                   package.object_name, package.unit.empty() ? "no unit" : package.unit,
                   package.mesh.triangles.size(), result.merged->triangles.size(), volume, printed)});
}

void claim_beams(const ExportedPrinter& result, Verdict* verdict) {
  if (!result.beams) return;
  const Package& package = *result.beams;
  double volume = 0;
  for (const Beam& beam : package.beams) {
    const double length = (package.mesh.vertices[beam.a] - package.mesh.vertices[beam.b]).norm();
    volume += std::numbers::pi * beam.radius_a_mm * beam.radius_b_mm * length;
  }
  constexpr double kRounding = 1e-4;  // nodes are floats in the package
  verdict->claims.push_back(
      {"frame-beams.3mf is the frame",
       package.unit == "millimeter" && package.required_extensions == "b" &&
           package.beams.size() == result.frame.struts.size() &&
           std::abs(volume - result.frame_volume_mm3) <= kRounding * result.frame_volume_mm3,
       fmt::format("{} beams of {:.1f} mm3 in {}; {} struts of {:.1f} mm3 reported", package.beams.size(),
                   volume, package.unit, result.frame.struts.size(), result.frame_volume_mm3)});
}

void claim_compact(const ExportedPrinter& result, Verdict* verdict) {
  if (!result.compact) return;
  const TriangleMesh& mesh = *result.compact;
  const EdgeCount edges = count_edges(mesh);
  const double volume = signed_volume(mesh);
  verdict->claims.push_back(
      {"compact mesh",
       edges.unmatched + edges.crowded + edges.degenerate == 0 &&
           mesh.triangles.size() == result.compact_triangles &&
           std::abs(volume - result.compact_volume_mm3) <= 1e-4 * std::abs(volume) && volume > 0,
       fmt::format(
           "{} triangles (reported {}), {} edges without their opposite, {} with more than two triangles, "
           "{} collapsed triangles; {:.1f} mm3 (reported {:.1f})",
           mesh.triangles.size(), result.compact_triangles, edges.unmatched, edges.crowded, edges.degenerate,
           volume, result.compact_volume_mm3)});
  // Every few corners of either, so somewhat less than the report may be found, and never much more.
  const double there = greatest_distance(mesh, Surface(*result.merged));
  const double back = greatest_distance(*result.merged, Surface(mesh));
  const double allowed = 1.1 * result.compact_deviation_mm + 0.01;
  verdict->claims.push_back(
      {"compact mesh is near the full one", std::max(there, back) <= allowed,
       fmt::format("its corners are {:.3f} mm from the full mesh at most, those of the full mesh "
                   "{:.3f} mm from it; reported {:.3f} mm",
                   there, back, result.compact_deviation_mm)});
}

}  // namespace skinframe::check
