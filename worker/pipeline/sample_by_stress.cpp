// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/pipeline/sample_by_stress.h"

#include <fmt/format.h>

#include "worker/drain/place_openings.h"
#include "worker/frame/vertex_graph.h"
#include "worker/pipeline/place_loads.h"

namespace skinframe {
namespace {

// Below this share of the solid the map says too little about it to go without a word.
constexpr double kLeastCovered = 0.8;

// As often holes are placed anew because nodes could not follow a rim.
constexpr int kMostPlacings = 6;

PlacedOpenings place_holes(const PreparedSolid& prepared, const Skin& skin, const StressMap* stress,
                           const DrainHoleRule& asked, const std::vector<Load>& loads,
                           const std::vector<Opening>& refused, const RunContext& context) {
  const OpeningRule rule{asked.diameter_mm, asked.least_diameter_mm, asked.least_count};
  std::vector<KeepAway> keep_away;
  for (const StressLoad& load : loads_at_points(loads, prepared.solid))
    keep_away.push_back({load.point_mm, load.radius_mm});
  return place_openings(prepared.solid.mesh(), skin, prepared.contact.hull, stress, rule,
                        split_pieces(skin.inner_surface), keep_away, refused, context);
}

// Where nodes cannot follow a rim, holes are placed anew, elsewhere or smaller; after kMostPlacings those are
// left out.
Result<SampledFrame> sample_with_holes(const PreparedSolid& prepared, const Skin& skin, FrameOptions options,
                                       const DrainHoleRule& asked, const std::vector<Load>& loads, Laps& laps,
                                       RunContext& context) {
  std::vector<Opening> refused;
  PlacedOpenings placed = place_holes(prepared, skin, options.stress, asked, loads, refused, context);
  for (int placings = 1;; ++placings) {
    if (context.cancelled()) return cancelled_error();
    laps.lap("drain");
    options.openings = placed.openings;
    auto sampled = sample_frame(skin, options, context);
    laps.lap("sample");
    if (sampled && !sampled->unopened.empty()) {
      refused.insert(refused.end(), sampled->unopened.begin(), sampled->unopened.end());
      if (placings < kMostPlacings) {
        placed = place_holes(prepared, skin, options.stress, asked, loads, refused, context);
        continue;
      }
      for (const Opening& opening : sampled->unopened) {
        std::erase_if(placed.openings,
                      [&](const Opening& other) { return other.centre_mm == opening.centre_mm; });
        placed.warnings.push_back(
            fmt::format("a drain hole at ({:.1f}, {:.1f}, {:.1f}) mm is left out: the skin's nodes cannot "
                        "follow its rim; "
                        "more --skin-nodes or a smaller hole in the printer's profile may help",
                        opening.centre_mm.x(), opening.centre_mm.y(), opening.centre_mm.z()));
      }
      continue;
    }
    if (sampled) {
      auto& warnings = sampled.value().warnings;
      warnings.insert(warnings.end(), placed.warnings.begin(), placed.warnings.end());
    }
    return sampled;
  }
}

}  // namespace

FrameOptions frame_options(const PrinterRequest& request, const JobRequest& job) {
  FrameOptions options;
  options.skin_nodes = job.options.skin_nodes;
  options.internal_nodes = job.options.internal_nodes;
  options.plate.tensile_modulus_mpa = request.material.tensile_modulus_mpa;
  options.plate.displacement_limit_mm = job.options.displacement_limit_mm;
  options.strut_radius_mm = request.printer.min_radius_mm;
  options.slenderness = request.material.slenderness;
  return options;
}

SamplingFacts sampling_facts(const SampledFrame& sampled, const std::string& density) {
  SamplingFacts facts;
  facts.density = density;
  facts.skin_nodes_requested = sampled.skin_nodes_requested;
  facts.skin_nodes_sampled = sampled.skin_nodes_sampled;
  facts.skin_nodes = sampled.frame.skin_node_count;
  facts.internal_nodes = static_cast<int>(sampled.frame.nodes_mm.size()) - sampled.frame.skin_node_count;
  facts.angles = sampled.angles;
  facts.worst_outward_chord_mm = sampled.worst_outward_chord_mm;
  facts.worst_inward_chord_mm = sampled.worst_inward_chord_mm;
  facts.skin_struts_outside = sampled.skin_struts_outside;
  facts.struts_left_out_crossing = sampled.struts_left_out_crossing;
  return facts;
}

Result<SampledFrame> sample_by_stress(const PreparedSolid& prepared, const Skin& skin,
                                      const PrinterRequest& request, const JobRequest& job, Laps& laps,
                                      PrinterReport* report, RunContext& context) {
  StressOptions stress_options;
  stress_options.material.modulus_mpa = request.material.tensile_modulus_mpa;
  stress_options.density_g_cm3 = request.material.density_g_cm3;
  auto mapped = map_stress(skin, loads_at_points(job.loads, prepared.solid), stress_options, context);
  if (!mapped && mapped.error().kind == ErrorKind::kCancelled) return mapped.error();
  std::optional<StressMap> stress;
  if (mapped) {
    stress = std::move(mapped).value();
    if (stress->covered_volume_share() < kLeastCovered)
      report->warnings.push_back(fmt::format(
          "the stress map knows {:.0f} % of the solid; elsewhere skin nodes follow curvature alone",
          100 * stress->covered_volume_share()));
  } else {
    report->warnings.push_back(fmt::format(
        "no stress map could be made, so the skin nodes follow curvature alone: {}", mapped.error().message));
  }
  laps.lap("stress");

  context.report({.stage = Stage::kSample});
  FrameOptions options = frame_options(request, job);
  options.stress = stress ? &*stress : nullptr;
  const auto holes = request.printer.holes_to_make();
  auto sampled = holes ? sample_with_holes(prepared, skin, options, *holes, job.loads, laps, context)
                       : sample_frame(skin, options, context);
  if (!sampled) return sampled.error();
  report->warnings.insert(report->warnings.end(), sampled->warnings.begin(), sampled->warnings.end());
  report->sampling = sampling_facts(*sampled, stress ? "stress+curvature" : "curvature");
  if (stress) {
    report->sampling->stress_tetrahedra = stress->tetrahedra();
    report->sampling->stress_largest_mpa = stress->largest_mpa();
  }
  laps.lap("sample");
  return sampled;
}

}  // namespace skinframe
