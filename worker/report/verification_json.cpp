// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/report/verification_json.h"

#include "worker/report/geometry_json.h"
#include "worker/verify/pinch.h"

namespace skinframe {
namespace {

using nlohmann::json;

json or_null(const std::optional<double>& figure) { return figure ? json(*figure) : json(nullptr); }

json load_json(const LoadFigures& load) {
  return {{"name", load.name},
          {"max_displacement_mm", load.max_displacement_mm},
          {"at_mm", vector_json(load.at_mm)},
          {"load_displacement_mm", or_null(load.load_displacement_mm)},
          {"max_skin_stress_mpa", load.skin_stress_mpa},
          {"max_strut_stress_mpa", load.strut_stress_mpa},
          {"stress_at_mm", vector_json(load.stress_at_mm)},
          {"buckling_factor", or_null(load.buckling_factor)}};
}

json fingers_json(const PinchedSite& site) {
  return {vector_json(site.fingers_mm[0]), vector_json(site.fingers_mm[1])};
}

json pinch_json(const PinchFigures& pinch) {
  json sites = json::array();
  for (const PinchedSite& site : pinch.sites)
    sites.push_back({{"fingers_mm", fingers_json(site)}, {"closing_mm", site.closing_mm}});
  return {{"force_n", kPinchForceN}, {"radius_mm", kPinchRadiusMm}, {"sites", sites}};
}

json rows_json(const Verification& v) {
  json rows = json::array();
  for (const ComparedRow& row : compare(v))
    rows.push_back({{"figure", row.name},
                    {"skin_frame", or_null(row.ours)},
                    {"hollow", or_null(row.hollow)},
                    {"solid", or_null(row.solid)},
                    {"skin_alone", or_null(row.skin_alone)},
                    {"better", to_string(row.winner)}});
  return rows;
}

json weights_json(const Verification& v) {
  const auto weight = [](const std::optional<DesignFigures>& d) {
    return d ? json(d->weight_g) : json(nullptr);
  };
  return {{"skin_frame", v.ours.weight_g},
          {"hollow", weight(v.hollow)},
          {"solid", weight(v.solid)},
          {"skin_alone", weight(v.skin_alone)}};
}

json design_json(const std::optional<DesignFigures>& design) {
  if (!design) return nullptr;
  json loads = json::array();
  for (const LoadFigures& load : design->loads)
    loads.push_back({{"name", load.name},
                     {"max_displacement_mm", load.max_displacement_mm},
                     {"load_displacement_mm", or_null(load.load_displacement_mm)},
                     {"buckling_factor", or_null(load.buckling_factor)}});
  const auto& pinch = design->pinch;
  return {{"weight_g", design->weight_g},
          {"loads", loads},
          {"pinch_mean_mm", pinch ? json(pinch->mean_mm) : json(nullptr)},
          {"pinch_max_mm", pinch ? json(pinch->max_mm) : json(nullptr)}};
}

}  // namespace

json to_json(const Verification& v) {
  json loads = json::array();
  for (const LoadFigures& load : v.ours.loads) loads.push_back(load_json(load));
  json out = {{"label", "verified"},
              {"model", "thin shell (OPT, DKT) and Timoshenko struts, rigid joints, nu 0.35, linear"},
              {"max_displacement_mm", v.ours.max_displacement_mm()},
              {"max_stress_mpa", v.ours.max_stress_mpa()},
              {"strength_mpa", or_null(v.strength_mpa)},
              {"safety_factor", or_null(v.safety_factor)},
              {"buckling_factor", or_null(v.ours.buckling_factor())},
              {"euler_factor", or_null(v.euler_factor)},
              {"euler_strut", v.euler_strut},
              {"loads", loads},
              {"balance", {{"force", v.balance_force}, {"moment", v.balance_moment}}},
              {"mesh",
               {{"levels", v.levels},
                {"nodes", v.nodes},
                {"triangles", v.triangles},
                {"error_estimate", v.mesh_error}}},
              {"cpu_seconds", v.cpu_seconds},
              {"comparison",
               {{"rows", rows_json(v)},
                {"weight_g", weights_json(v)},
                {"designs",
                 {{"skin_frame", design_json(v.ours)},
                  {"hollow", design_json(v.hollow)},
                  {"solid", design_json(v.solid)},
                  {"skin_alone", design_json(v.skin_alone)}}},
                {"verdict", v.verdict}}}};
  if (v.hollow) {
    out["hollow_max_displacement_mm"] = v.hollow->max_displacement_mm();
    out["hollow_thickness_mm"] = v.hollow_wall_mm;
  } else {
    out["comparison"]["hollow_missing"] = v.hollow_missing;
  }
  if (v.solid)
    out["solid_max_displacement_mm"] = v.solid->max_displacement_mm();
  else
    out["comparison"]["solid_missing"] = v.solid_missing;
  if (const auto& pinch = v.ours.pinch) {
    out["pinch"] = pinch_json(*pinch);
    out["pinch_sites"] = pinch->sites.size();
    out["pinch_mean_mm"] = pinch->mean_mm;
    out["pinch_max_mm"] = pinch->max_mm;
    if (pinch->worst >= 0) out["pinch_worst_mm"] = fingers_json(pinch->sites[pinch->worst]);
  }
  return out;
}

json not_verified_json(const std::string& reason) { return {{"label", "not verified"}, {"reason", reason}}; }

json verified_summary_json(const Verification& v) {
  json out = {{"max_displacement_mm", v.ours.max_displacement_mm()},
              {"max_stress_mpa", v.ours.max_stress_mpa()},
              {"verdict", v.verdict}};
  const auto add = [&](const char* key, const std::optional<double>& figure) {
    if (figure) out[key] = *figure;
  };
  add("safety_factor", v.safety_factor);
  add("buckling_factor", v.ours.buckling_factor());
  if (v.ours.pinch) out["pinch_max_mm"] = v.ours.pinch->max_mm;
  if (v.solid) out["solid_max_displacement_mm"] = v.solid->max_displacement_mm();
  if (v.hollow) {
    out["hollow_max_displacement_mm"] = v.hollow->max_displacement_mm();
    out["hollow_thickness_mm"] = v.hollow_wall_mm;
    if (v.hollow->pinch) out["hollow_pinch_max_mm"] = v.hollow->pinch->max_mm;
  }
  return out;
}

}  // namespace skinframe
