// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/check/check.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "worker/check/claims.h"

namespace skinframe::check {
namespace {

Verdict judge(const ExportedPrinter& result, const std::optional<ExportedOrientation>& orientation) {
  Verdict verdict{result.printer, {}, {}};
  if (!result.solid() && (result.frame.struts.empty() || result.frame.nodes_mm.empty())) {
    verdict.claims.push_back({"frame", false, "frame.json has no struts"});
    return verdict;
  }
  if (!result.merged) {
    claim_frame(result, nullptr, &verdict);
    claim_stages(result, &verdict);
    claim_mechanics(result, &verdict);
    claim_bounds(result, &verdict);
    return verdict;
  }
  TriangleMesh outer_mesh, cavity;
  split_surfaces(result, &outer_mesh, &cavity);
  if (outer_mesh.triangles.empty()) {
    verdict.claims.push_back({"watertight", false, "skin-frame.stl has no triangles"});
    return verdict;
  }
  const Surface outer(outer_mesh);
  claim_mesh(result, outer_mesh, cavity, outer, &verdict);
  claim_walls(result, &verdict);
  claim_crossings(result, &verdict);
  claim_smoothing(result, outer_mesh, cavity, outer, &verdict);
  claim_package(result, &verdict);
  claim_beams(result, &verdict);
  claim_compact(result, &verdict);
  if (result.solid()) {
    claim_solid(result, outer_mesh, outer, &verdict);
    claim_balance(result, outer_mesh, &verdict);
    return verdict;
  }
  claim_frame(result, &outer, &verdict);
  claim_stages(result, &verdict);
  claim_printed_struts(result, cavity, outer, &verdict);
  if (result.supports) {
    claim_supports(result, outer, &verdict);
    claim_overhang(result, outer_mesh, outer, &verdict);
    claim_layers(result, &verdict);
    if (orientation && orientation->printer == result.printer)
      claim_orientation(*orientation, result, outer_mesh, &verdict);
  }
  claim_drain(result, outer_mesh, cavity, outer, &verdict);
  claim_mechanics(result, &verdict);
  claim_bounds(result, &verdict);
  claim_balance(result, outer_mesh, &verdict);
  claim_verified(result, outer_mesh, outer, &verdict);
  return verdict;
}

Verdict judge_solution(const ExportedPrinter& solution) {
  Verdict verdict{solution.printer, {}, {}};
  if (solution.frame.struts.empty() || solution.frame.nodes_mm.empty()) {
    verdict.claims.push_back({"frame", false, "result.json has no struts"});
    return verdict;
  }
  claim_solution(solution, &verdict);
  claim_stages(solution, &verdict);
  claim_mechanics(solution, &verdict);
  claim_bounds(solution, &verdict);
  return verdict;
}

}  // namespace

Result<std::vector<Verdict>> check_directory(const std::filesystem::path& directory, RunContext& context) {
  auto exported = read_exported(directory, context);
  if (!exported) return exported.error();
  std::vector<Verdict> verdicts;
  try {
    for (const ExportedPrinter& result : exported->printers)
      verdicts.push_back(judge(result, exported->orientation));
    if (exported->solution) verdicts.push_back(judge_solution(*exported->solution));
  } catch (const std::exception& error) {  // CGAL's preconditions on a surface that is none
    return invalid_input(
        fmt::format("{}: the exported surface cannot be examined: {}", directory.string(), error.what()));
  }
  return verdicts;
}

std::string to_text(const std::vector<Verdict>& verdicts) {
  std::string text;
  for (const Verdict& verdict : verdicts) {
    text += fmt::format("{}: {}\n", verdict.printer, verdict.holds() ? "yes, every claim holds" : "NO");
    for (const Claim& claim : verdict.claims)
      text += fmt::format("  {:3}  {}: {}\n", claim.holds ? "yes" : "NO", claim.name, claim.measured);
    for (const std::string& note : verdict.notes) text += fmt::format("  note {}\n", note);
  }
  return text;
}

std::string to_json_text(const std::vector<Verdict>& verdicts) {
  nlohmann::json printers = nlohmann::json::array();
  bool holds = !verdicts.empty();
  for (const Verdict& verdict : verdicts) {
    nlohmann::json claims = nlohmann::json::array();
    for (const Claim& claim : verdict.claims)
      claims.push_back({{"claim", claim.name}, {"holds", claim.holds}, {"measured", claim.measured}});
    printers.push_back({{"printer", verdict.printer},
                        {"holds", verdict.holds()},
                        {"claims", claims},
                        {"notes", verdict.notes}});
    holds = holds && verdict.holds();
  }
  return nlohmann::json{{"holds", holds}, {"printers", printers}}.dump(2) + "\n";
}

}  // namespace skinframe::check
