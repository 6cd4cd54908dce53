// SPDX-License-Identifier: GPL-3.0-or-later
// The result of solve-frame as JSON: the reduced frame as a problem file of its own (see problem_file.h, with
// radii and displacements), and beside it
//
//   "termination": {"reason", "detail", "violated_constraint", "best_reachable_displacement_mm"},
//   "volumes_mm3": {"initial", "size", "topology", "geometry"}, "counts": the same keys, each {"nodes",
//   "struts"}, "lower_bound_mm3" and "gap" (size volume / bound - 1), "relaxed_lower_bound_mm3" and
//   "relaxed_gap" (topology volume / bound - 1; removable struts may be absent) or null, "certificate" when
//   infeasible and proven (proof_json.h; of this frame) or null, "iterations": {"outer", "factorisations",
//   "interior_point", "factorisations"}, "kkt_residual", "evaluation": the ratios of mechanics/evaluation.h,
//   "seconds": {stage: s}, "node_origin", "strut_origin": indices in the input, "strut_sizes" (strut_sizes.h),
//   and on each load case
//   "axial_force_n", "axial_stress_mpa", "shear_stress_mpa" (one a strut), "reactions_n" (one a node).
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "worker/optimize/optimize_frame.h"

namespace skinframe {

//
// What proves the bounds is of the nodes and struts that were given, which a reduced frame has no longer:
//
//   "lower_bound_proof", "relaxed_lower_bound_proof" (proof_json.h) or null, and "given": the problem file of
//   that frame, where there is a proof.
nlohmann::json result_json(const OptimizeResult& result, const FrameProblem& given);

// Written beside `path` first and renamed: no half file is ever seen.
Status write_result(const nlohmann::json& result, const std::filesystem::path& path);

}  // namespace skinframe
