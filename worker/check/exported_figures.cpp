// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/check/exported_figures.h"

#include "worker/check/exported_verification.h"
#include "worker/check/json_fields.h"

namespace skinframe::check {

using nlohmann::json;

namespace {

void parse_bounds(const json& item, ExportedPrinter* out) {
  out->lower_bound_mm3 = optional_number(item, "lower_bound_mm3");
  out->gap = optional_number(item, "gap");
  out->relaxed_lower_bound_mm3 = optional_number(item, "relaxed_lower_bound_mm3");
  out->relaxed_gap = optional_number(item, "relaxed_gap");
}

}  // namespace

ExportedPrinter parse_printer(const json& item) {
  ExportedPrinter out;
  out.printer = item.at("printer").get<std::string>();
  out.material = item.at("material").get<std::string>();
  out.termination = item.at("termination").at("reason").get<std::string>();
  const json& profile = item.at("profile");
  out.eta_mm = profile.at("min_radius_mm").get<double>();
  out.skin_thickness_mm = profile.at("skin_thickness_mm").get<double>();
  out.max_internal_radius_mm = profile.at("max_internal_radius_mm").get<double>();
  out.density_g_cm3 = profile.at("density_g_cm3").get<double>();
  out.tray_mm = vector3(profile.at("tray_mm"));
  out.best_reachable_displacement_mm = optional_number(item, "best_reachable_displacement_mm");
  out.solid_volume_mm3 = item.at("solid_volume_mm3").get<double>();
  out.skin_volume_mm3 = item.at("skin_volume_mm3").get<double>();
  out.frame_volume_mm3 = item.at("frame_volume_mm3").get<double>();
  out.total_volume_mm3 = item.at("total_volume_mm3").get<double>();
  out.ratio = item.at("ratio").get<double>();
  out.size_volume_mm3 = item.at("size_volume_mm3").get<double>();
  out.topology_volume_mm3 = item.at("topology_volume_mm3").get<double>();
  out.geometry_volume_mm3 = item.at("geometry_volume_mm3").get<double>();
  out.max_displacement_mm = item.at("max_displacement_mm").get<double>();
  out.max_axial_ratio = item.at("max_axial_ratio").get<double>();
  out.max_shear_ratio = item.at("max_shear_ratio").get<double>();
  out.min_radius_mm = item.at("min_radius_mm").get<double>();
  out.balance = item.at("balance").get<std::string>();
  out.violated_constraint = item.value("violated_constraint", "");
  out.balance_margin_mm = optional_number(item, "balance_margin_mm");
  out.printed_balance_margin_mm = optional_number(item, "printed_balance_margin_mm");
  parse_bounds(item, &out);
  out.infeasibility_proven = item.value("infeasibility_proven", false);
  if (item.contains("smoothing") && item.at("smoothing").at("applied").get<bool>())
    out.added_skin_mm3 = item.at("smoothing").at("added_skin_mm3").get<double>();
  if (item.contains("sampling"))
    out.skin_struts_outside = item.at("sampling").at("skin_struts_outside").get<int>();
  out.final_nodes = item.at("counts").at("geometry").at("nodes").get<int>();
  out.final_struts = item.at("counts").at("geometry").at("struts").get<int>();
  if (item.contains("verification")) out.verification = parse_verification(item.at("verification"));
  if (!out.infeasible()) {
    out.printed_volume_mm3 = item.at("printed_volume_mm3").get<double>();
    out.printed_ratio = item.at("printed_ratio").get<double>();
    out.weight_g = item.at("weight_g").get<double>();
    out.voxel_mm = item.at("voxel_mm").get<double>();
  }
  return out;
}

ExportedPrinter parse_solution(const json& item) {
  ExportedPrinter figures;
  figures.printer = "frame";
  const json& termination = item.at("termination");
  figures.termination =
      termination.at("reason").get<std::string>() == "infeasible" ? "INFEASIBLE" : "OPTIMAL";
  figures.violated_constraint = termination.value("violated_constraint", "");
  figures.best_reachable_displacement_mm = optional_number(termination, "best_reachable_displacement_mm");
  const json& volumes = item.at("volumes_mm3");
  figures.size_volume_mm3 = volumes.at("size").get<double>();
  figures.topology_volume_mm3 = volumes.at("topology").get<double>();
  figures.geometry_volume_mm3 = volumes.at("geometry").get<double>();
  figures.final_nodes = item.at("counts").at("geometry").at("nodes").get<int>();
  figures.final_struts = item.at("counts").at("geometry").at("struts").get<int>();
  parse_bounds(item, &figures);
  figures.infeasibility_proven = item.contains("certificate") && !item.at("certificate").is_null();
  const json& evaluation = item.at("evaluation");
  figures.frame_volume_mm3 = evaluation.at("frame_volume_mm3").get<double>();
  figures.max_displacement_mm = optional_number(evaluation, "max_displacement_mm").value_or(0.0);
  figures.max_axial_ratio = optional_number(evaluation, "max_axial_ratio").value_or(0.0);
  figures.max_shear_ratio = optional_number(evaluation, "max_shear_ratio").value_or(0.0);
  figures.min_radius_mm = evaluation.at("min_radius_mm").get<double>();
  figures.balance_margin_mm = optional_number(evaluation, "balance_margin_mm");
  return figures;
}

}  // namespace skinframe::check
