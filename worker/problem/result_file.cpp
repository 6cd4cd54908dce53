// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/problem/result_file.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <system_error>

#include "worker/mechanics/equilibrium.h"
#include "worker/problem/problem_file.h"
#include "worker/problem/proof_json.h"
#include "worker/problem/strut_sizes.h"

namespace skinframe {
namespace {

using nlohmann::json;

json optional_json(const std::optional<double>& value) { return value ? json(*value) : json(nullptr); }
json finite_json(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json evaluation_json(const Evaluation& e) {
  return {{"max_displacement_mm", e.max_displacement_mm},
          {"displacement_ratio", e.displacement_ratio},
          {"worst_node", e.worst_node},
          {"worst_load_case", e.worst_load_case},
          {"max_axial_ratio", e.max_axial_ratio},
          {"max_shear_ratio", e.max_shear_ratio},
          {"max_slenderness_ratio", e.max_slenderness_ratio},
          {"radius_violation_mm", e.radius_violation_mm},
          {"min_radius_mm", e.min_radius_mm},
          {"widened_struts", e.widened_struts},
          {"balance_margin_mm", finite_json(e.balance_margin_mm)},
          {"frame_volume_mm3", e.frame_volume_mm3},
          {"equilibrium_residual", e.equilibrium_residual}};
}

void add_forces(const OptimizeResult& result, json& cases) {
  const std::vector<double> areas = areas_of(result.radii_mm);
  const std::vector<CaseResponse> responses = solve_equilibrium(result.problem, areas);
  for (std::size_t k = 0; k < responses.size(); ++k) {
    json& load = cases[k];
    load["axial_stress_mpa"] = responses[k].axial_stress_mpa;
    load["shear_stress_mpa"] = responses[k].shear_stress_mpa;
    std::vector<double> forces = responses[k].axial_stress_mpa;
    for (std::size_t j = 0; j < forces.size(); ++j) forces[j] *= areas[j];
    load["axial_force_n"] = forces;
    json& reactions = load["reactions_n"] = json::array();
    for (const Eigen::Vector3d& r : responses[k].reactions_n) reactions.push_back({r.x(), r.y(), r.z()});
  }
}

void add_bounds(const OptimizeResult& result, const FrameProblem& given, json& document) {
  document["lower_bound_mm3"] = optional_json(result.lower_bound_mm3);
  document["gap"] = optional_json(result.gap);
  document["relaxed_lower_bound_mm3"] = optional_json(result.relaxed_lower_bound_mm3);
  document["relaxed_gap"] = optional_json(result.relaxed_gap);
  document["certificate"] = result.certificate ? certificate_json(*result.certificate) : json(nullptr);
  add_bound_proofs(result, given, document);
  if (result.lower_bound_proof) document["given"] = to_json(given, {}, {});
}

}  // namespace

json result_json(const OptimizeResult& result, const FrameProblem& given) {
  json document = to_json(result.problem, result.radii_mm, result.displacements_mm);
  add_forces(result, document["load_cases"]);
  document["termination"] = {
      {"reason", to_string(result.reason)},
      {"detail", result.detail},
      {"violated_constraint", result.violated_constraint},
      {"best_reachable_displacement_mm", optional_json(result.best_reachable_displacement_mm)}};
  const std::pair<const char*, const StageRecord*> stages[] = {{"initial", &result.initial},
                                                               {"size", &result.size},
                                                               {"topology", &result.topology},
                                                               {"geometry", &result.geometry}};
  for (const auto& [name, record] : stages) {
    document["volumes_mm3"][name] = record->volume_mm3;
    document["counts"][name] = {{"nodes", record->nodes}, {"struts", record->struts}};
  }
  add_bounds(result, given, document);
  document["iterations"] = {{"outer", result.outer_iterations},
                            {"interior_point", result.interior_point_iterations},
                            {"factorisations", result.factorisations}};
  document["kkt_residual"] = result.kkt_residual;
  document["evaluation"] = evaluation_json(result.evaluation);
  document["seconds"] = result.seconds;
  document["node_origin"] = result.node_origin;
  document["strut_origin"] = result.strut_origin;
  document[kStrutSizes] = strut_sizes_json(result);
  return document;
}

Status write_result(const nlohmann::json& result, const std::filesystem::path& path) {
  std::filesystem::path beside = path;
  beside += ".part";
  {
    std::ofstream stream(beside, std::ios::binary);
    stream << result.dump() << '\n';
    stream.close();
    if (!stream) return io_error(fmt::format("{}: cannot be written", beside.string()));
  }
  std::error_code failure;
  std::filesystem::rename(beside, path, failure);
  if (failure) return io_error(fmt::format("{}: {}", path.string(), failure.message()));
  return ok_status();
}

}  // namespace skinframe
