// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/report/geometry_json.h"

namespace skinframe {

using nlohmann::json;

namespace {

json tried_json(const OrientationFacts::Tried& tried) {
  json rows = json::array();
  for (int row = 0; row < 3; ++row) rows.push_back(vector_json(tried.rotation.row(row)));
  return {{"rotation", rows},
          {"support_estimate_mm3", tried.support_estimate_mm3},
          {"standing_margin_mm", tried.margin_mm}};
}

}  // namespace

json vector_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

json smoothing_json(const SmoothingFacts& smoothing) {
  return {{"applied", smoothing.applied},
          {"detail_share", smoothing.detail.share},
          {"detail_rms_mm", smoothing.detail.rms_mm},
          {"added_skin_mm3", smoothing.added_skin_mm3}};
}

json drain_json(const DrainFacts& drain, double thickness_mm) {
  json sealed = json::array();
  const auto list = [](const std::vector<Opening>& openings) {
    json out = json::array();
    for (const Opening& opening : openings)
      out.push_back({{"centre_mm", vector_json(opening.centre_mm)},
                     {"axis", vector_json(opening.axis)},
                     {"diameter_mm", 2.0 * opening.radius_mm},
                     {"rise_mm", opening.rise_mm},
                     {"clear_mm", opening.clear_mm}});
    return out;
  };
  for (const SealedVoid& hollow : drain.sealed)
    sealed.push_back({{"volume_mm3", hollow.volume_mm3}, {"centre_mm", vector_json(hollow.centre_mm)}});
  return {{"rule", {{"diameter_mm", drain.rule_diameter_mm}, {"least_count", drain.rule_least_count}}},
          {"holes", list(drain.openings)},
          {"uncut", list(drain.uncut)},
          {"outer_triangles", drain.outer_triangles},
          {"caps",
           {{"count", drain.caps}, {"clearance_mm", drain.cap_clearance_mm}, {"thickness_mm", thickness_mm}}},
          {"sealed_voids", sealed}};
}

json thin_json(const ThinParts& thin) {
  json regions = json::array();
  for (const ThinRegion& region : thin.regions)
    regions.push_back({{"kind", to_string(region.kind)},
                       {"volume_mm3", region.volume_mm3},
                       {"mean_thickness_mm", region.mean_thickness_mm},
                       {"centre_mm", vector_json(region.centre_mm)}});
  return {{"volume_mm3", thin.volume_mm3},
          {"fraction", thin.fraction},
          {"region_count", thin.region_count},
          {"regions", regions}};
}

json sampling_json(const SamplingFacts& facts) {
  json out = {{"density", facts.density},
              {"skin_nodes_requested", facts.skin_nodes_requested},
              {"skin_nodes_sampled", facts.skin_nodes_sampled},
              {"skin_nodes", facts.skin_nodes},
              {"internal_nodes", facts.internal_nodes},
              {"mean_least_angle_degrees", facts.angles.mean},
              {"first_percentile_least_angle_degrees", facts.angles.first_percentile},
              {"least_angle_degrees", facts.angles.least},
              {"worst_outward_chord_mm", facts.worst_outward_chord_mm},
              {"worst_inward_chord_mm", facts.worst_inward_chord_mm},
              {"skin_struts_outside", facts.skin_struts_outside},
              {"struts_left_out_crossing", facts.struts_left_out_crossing}};
  if (facts.stress_tetrahedra) out["stress_tetrahedra"] = *facts.stress_tetrahedra;
  if (facts.stress_largest_mpa) out["stress_largest_mpa"] = *facts.stress_largest_mpa;
  return out;
}

json orientation_json(const OrientationFacts& facts) {
  return {{"printer", facts.printer.empty() ? json(nullptr) : json(facts.printer)},
          {"candidates", facts.candidates},
          {"passed_over", facts.passed_over},
          {"chosen", facts.chosen ? tried_json(*facts.chosen) : json(nullptr)},
          {"runner_up", facts.runner_up ? tried_json(*facts.runner_up) : json(nullptr)}};
}

}  // namespace skinframe
