// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/report/report.h"

#include "worker/mechanics/equilibrium.h"
#include "worker/report/geometry_json.h"
#include "worker/report/verification_json.h"

namespace skinframe {
namespace {

using nlohmann::json;

json stage_json(const StageRecord& stage) { return {{"nodes", stage.nodes}, {"struts", stage.struts}}; }

// Where the plate would have to pull: the object counts as clamped, and a real plate may let go there.
json tips_json(const OptimizeResult& result) {
  constexpr double kSilentN = 1e-6;
  json tips = json::array();
  const auto responses = solve_equilibrium(result.problem, areas_of(result.radii_mm));
  for (std::size_t c = 0; c < responses.size(); ++c) {
    double pull_n = 0;
    int nodes = 0;
    for (const Eigen::Vector3d& reaction : responses[c].reactions_n)
      if (reaction.z() < -kSilentN) {
        pull_n -= reaction.z();
        ++nodes;
      }
    if (nodes > 0)
      tips.push_back(
          {{"load_case", result.problem.load_cases[c].name}, {"pull_n", pull_n}, {"nodes", nodes}});
  }
  return tips;
}

void add_bounds(const OptimizeResult& result, json& out) {
  const auto add = [&](const char* name, const std::optional<double>& value) {
    if (value) out[name] = *value;
  };
  add("lower_bound_mm3", result.lower_bound_mm3);
  add("gap", result.gap);
  add("relaxed_lower_bound_mm3", result.relaxed_lower_bound_mm3);
  add("relaxed_gap", result.relaxed_gap);
  if (result.reason == Termination::kInfeasible) out["infeasibility_proven"] = result.certificate.has_value();
}

}  // namespace

const char* to_string(Reason reason) {
  switch (reason) {
    case Reason::kNone:
      return "NONE";
    case Reason::kPartial:
      return "PARTIAL";
    case Reason::kInvalidInput:
      return "INVALID_INPUT";
    case Reason::kDoesNotFit:
      return "DOES_NOT_FIT";
    case Reason::kInfeasible:
      return "INFEASIBLE";
    case Reason::kOutOfMemory:
      return "OUT_OF_MEMORY";
    case Reason::kInternal:
      return "INTERNAL";
    case Reason::kCancelled:
      return "CANCELLED";
    case Reason::kUnsupported:
      return "UNSUPPORTED";
  }
  return "INTERNAL";
}

Reason reason_of(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::kInvalidInput:
      return Reason::kInvalidInput;
    case ErrorKind::kDoesNotFit:
      return Reason::kDoesNotFit;
    case ErrorKind::kUnsupported:
      return Reason::kUnsupported;
    case ErrorKind::kIo:
      return Reason::kInternal;
    case ErrorKind::kCancelled:
      return Reason::kCancelled;
    case ErrorKind::kInternal:
      return Reason::kInternal;
  }
  return Reason::kInternal;
}

json mesh_json(const MeshFacts& facts, const Solid& solid, const Contact& contact) {
  json out = {{"name", facts.name},
              {"format", facts.format},
              {"vertices", solid.mesh().vertices.size()},
              {"triangles", solid.mesh().triangles.size()},
              {"size_mm", vector_json(solid.box().extent())},
              {"volume_mm3", solid.volume_mm3()},
              {"area_mm2", solid.area_mm2()},
              {"stands", contact.stands},
              {"standing_margin_mm", contact.margin_mm},
              {"repairs", facts.repairs},
              {"warnings", facts.warnings}};
  if (facts.orientation) out["orientation"] = orientation_json(*facts.orientation);
  return out;
}

json to_json(const Statistics& s) {
  json out = {{"solid_volume_mm3", s.solid_volume_mm3},
              {"skin_volume_mm3", s.skin_volume_mm3},
              {"frame_volume_mm3", s.frame_volume_mm3},
              {"total_volume_mm3", s.total_volume_mm3},
              {"ratio", s.ratio},
              {"printed_volume_mm3", s.printed_volume_mm3},
              {"printed_ratio", s.printed_ratio},
              {"weight_g", s.weight_g},
              {"skin_nodes", s.skin_nodes},
              {"nodes", s.nodes},
              {"struts", s.struts},
              {"max_displacement_mm", s.max_displacement_mm},
              {"balance", s.balance}};
  if (!s.verified.is_null()) out["verified"] = s.verified;
  if (!s.not_verified.empty()) out["not_verified"] = s.not_verified;
  return out;
}

json to_json(const PlannedSupports& supports) {
  const SupportFacts& facts = supports.facts;
  json out = {{"count", facts.internal + facts.external},
              {"internal", facts.internal},
              {"external", facts.external},
              {"length_mm", facts.length_mm},
              {"volume_mm3", facts.internal_volume_mm3 + facts.external_volume_mm3},
              {"internal_volume_mm3", facts.internal_volume_mm3},
              {"external_volume_mm3", facts.external_volume_mm3},
              {"weight_g", facts.weight_g},
              {"nodes_held_by_wall", supports.plan.held_by_wall},
              {"nodes_held_by_plate", supports.plan.held_by_plate},
              {"print_state", {{"worst_vertical_deformation_mm", supports.state.worst_deformation_mm}}}};
  const Overhang& overhang = supports.overhang;
  const double beyond = overhang.roof_beyond_mm2 + overhang.underside_beyond_mm2;
  out["overhang"] = {
      {"flat_roof_mm2", overhang.roof_mm2},
      {"flat_underside_mm2", overhang.underside_mm2},
      {"roof_beyond_mm2", overhang.roof_beyond_mm2},
      {"underside_beyond_mm2", overhang.underside_beyond_mm2},
      {"cavity_surface_mm2", supports.cavity_surface_mm2},
      {"beyond_share", supports.cavity_surface_mm2 > 0 ? beyond / supports.cavity_surface_mm2 : 0}};
  if (supports.state.limit_mm) out["print_state"]["limit_mm"] = *supports.state.limit_mm;
  return out;
}

json refused_json(const PrinterReport& report) {
  return {{"printer", report.printer},
          {"material", report.material},
          {"reason", to_string(report.reason)},
          {"detail", report.detail},
          {"warnings", report.warnings}};
}

json to_json(const PrinterReport& report) {
  if (!report.optimised && !report.is_solid) return refused_json(report);
  const OptimizeResult no_frame;  // of a solid: nothing counted, nothing loaded
  const OptimizeResult& result = report.optimised ? *report.optimised : no_frame;
  const Statistics& s = report.statistics;
  json out = {{"printer", report.printer},
              {"material", report.material},
              {"reason", to_string(report.reason)},
              {"detail", report.detail},
              {"model", "paper (axial and shear springs, no rotations)"},
              {"profile",
               {{"min_radius_mm", report.min_radius_mm},
                {"skin_thickness_mm", report.skin_thickness_mm},
                {"max_internal_radius_mm", report.max_internal_radius_mm},
                {"tray_mm", vector_json(report.tray_mm)},
                {"density_g_cm3", report.density_g_cm3}}},
              {"solid_volume_mm3", s.solid_volume_mm3},
              {"skin_volume_mm3", s.skin_volume_mm3},
              {"frame_volume_mm3", s.frame_volume_mm3},
              {"total_volume_mm3", s.total_volume_mm3},
              {"ratio", s.ratio},
              {"counts",
               {{"initial", stage_json(result.initial)},
                {"size", stage_json(result.size)},
                {"topology", stage_json(result.topology)},
                {"geometry", stage_json(result.geometry)}}},
              {"size_volume_mm3", result.size.volume_mm3},
              {"topology_volume_mm3", result.topology.volume_mm3},
              {"geometry_volume_mm3", result.geometry.volume_mm3},
              {"iterations",
               {{"outer", result.outer_iterations},
                {"interior_point", result.interior_point_iterations},
                {"factorisations", result.factorisations}}},
              {"max_displacement_mm", result.evaluation.max_displacement_mm},
              {"max_axial_ratio", result.evaluation.max_axial_ratio},
              {"max_shear_ratio", result.evaluation.max_shear_ratio},
              {"min_radius_mm", result.evaluation.min_radius_mm},
              {"balance", s.balance},
              {"tips", report.optimised ? tips_json(result) : json::array()},
              {"warnings", report.warnings},
              {"seconds", report.seconds},
              {"termination", {{"reason", report.termination}, {"detail", report.termination_detail}}}};
  // Of which model the figures above are; those of the other one stand in "verification", under its label.
  if (report.optimised) out["label"] = out["termination"]["label"] = "paper model";
  out["files"] = report.files;
  if (report.thin) out["thin"] = thin_json(*report.thin);
  if (report.smoothing) out["smoothing"] = smoothing_json(*report.smoothing);
  if (report.sampling) out["sampling"] = sampling_json(*report.sampling);
  if (report.verification)
    out["verification"] = to_json(*report.verification);
  else if (!s.not_verified.empty())
    out["verification"] = not_verified_json(s.not_verified);
  if (report.warm_start)
    out["warm_start"] = {{"job_id", report.warm_start->job_id},
                         {"reused", report.warm_start->reused},
                         {"detail", report.warm_start->detail}};
  if (report.drain) out["drain_holes"] = drain_json(*report.drain, report.skin_thickness_mm);
  if (report.supports && report.voxel_mm) out["supports"] = to_json(*report.supports);
  if (s.balance_margin_mm) out["balance_margin_mm"] = *s.balance_margin_mm;
  if (s.printed_balance_margin_mm) out["printed_balance_margin_mm"] = *s.printed_balance_margin_mm;
  add_bounds(result, out);
  if (result.best_reachable_displacement_mm)
    out["best_reachable_displacement_mm"] = *result.best_reachable_displacement_mm;
  if (!result.violated_constraint.empty()) out["violated_constraint"] = result.violated_constraint;
  if (report.voxel_mm) {
    out["voxel_mm"] = *report.voxel_mm;
    out["triangles"] = report.triangles;
    out["crossings"] = report.crossings;
    if (report.compact)
      out["compact"] = {{"triangles", report.compact->triangles},
                        {"volume_mm3", report.compact->volume_mm3},
                        {"deviation_mm", report.compact->deviation_mm},
                        {"crossings", report.compact->crossings}};
    out["printed_volume_mm3"] = s.printed_volume_mm3;
    out["printed_ratio"] = s.printed_ratio;
    out["weight_g"] = s.weight_g;
    if (report.price_per_kg) out["cost"] = *report.price_per_kg * s.weight_g * 1e-3;
  }
  return out;
}

}  // namespace skinframe
