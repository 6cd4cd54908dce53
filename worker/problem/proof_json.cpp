// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/problem/proof_json.h"

#include "worker/optimize/design.h"

namespace skinframe {
namespace {

using nlohmann::json;

json proof_json(const DualProof& proof, bool removable_may_vanish, const DualValue& value) {
  json fields = json::array();
  for (const VirtualField& field : proof.fields) {
    json displacements = json::array();
    for (const Eigen::Vector3d& d : field.displacements_mm) displacements.push_back({d.x(), d.y(), d.z()});
    fields.push_back({{"load_case", field.load_case},
                      {"displacement_multiplier", field.displacement_multiplier},
                      {"stress_multiplier", field.stress_multiplier},
                      {"displacements_mm", std::move(displacements)}});
  }
  return {{"volume_weight", proof.volume_weight},
          {"radii", removable_may_vanish ? "removable_may_vanish" : "within_bounds"},
          {"feasibility_tolerance", proof.feasibility_tolerance},
          {"fields", std::move(fields)},
          {"balance_multipliers", proof.balance_multipliers},
          {"value", value.value},
          {"normalisation", value.normalisation}};
}

}  // namespace

json certificate_json(const InfeasibilityCertificate& certificate) {
  json document = proof_json(certificate.proof, false, {certificate.value, certificate.normalisation});
  document["constraint"] = certificate.constraint;
  document["proven_ratio"] = certificate.proven_ratio;
  return document;
}

json bound_proof_json(const FrameProblem& problem, const DualProof& proof, bool removable_may_vanish) {
  const AreaBox box =
      area_box(problem, removable_may_vanish ? removable_struts(problem) : std::vector<bool>{});
  return proof_json(proof, removable_may_vanish, dual_value(problem, box, proof));
}

void add_bound_proofs(const OptimizeResult& result, const FrameProblem& given, json& document) {
  const auto proof = [&](const std::optional<DualProof>& of, bool removable_may_vanish) {
    return of ? bound_proof_json(given, *of, removable_may_vanish) : json(nullptr);
  };
  document["lower_bound_proof"] = proof(result.lower_bound_proof, false);
  document["relaxed_lower_bound_proof"] = proof(result.relaxed_lower_bound_proof, true);
}

}  // namespace skinframe
