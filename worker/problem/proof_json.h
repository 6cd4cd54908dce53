// SPDX-License-Identifier: GPL-3.0-or-later
// Dual proofs as JSON, so that who has the frame's problem file can verify them by arithmetic alone
// (optimize/dual_proof.h has the inequality):
//
//   {"volume_weight": 1 or 0, "radii": "within_bounds" or "removable_may_vanish", "feasibility_tolerance",
//    "fields": [{"load_case": index, "displacement_multiplier", "stress_multiplier", "displacements_mm":
//    [[x,y,z] one a node]}], "balance_multipliers": [one a half plane] or [], "value", "normalisation"}
//
// A certificate of infeasibility is one of volume_weight 0 and value > 0, with the "constraint" it is about
// and the "proven_ratio": limits that many times as wide are out of reach by it as well. Removable: struts
// that are not of the skin, and those whose min_radius_mm is 0.
#pragma once

#include <nlohmann/json.hpp>

#include "worker/optimize/infeasibility_certificate.h"
#include "worker/optimize/optimize_frame.h"

namespace skinframe {

nlohmann::json certificate_json(const InfeasibilityCertificate& certificate);

// Of a lower bound on the volume of `problem`; "value" is what dual_value says.
nlohmann::json bound_proof_json(const FrameProblem& problem, const DualProof& proof,
                                bool removable_may_vanish);

// "lower_bound_proof" and "relaxed_lower_bound_proof" of `result`, each null where there is none; `given` is
// the problem that was optimised.
void add_bound_proofs(const OptimizeResult& result, const FrameProblem& given, nlohmann::json& document);

}  // namespace skinframe
