// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/optimize_frame.h"

#include <fmt/format.h>

#include <chrono>
#include <exception>
#include <numeric>

#include "worker/optimize/block_ldlt.h"
#include "worker/optimize/session.h"
#include "worker/optimize/size_frame.h"

namespace skinframe {
namespace {

StageRecord record_of(const FrameProblem& problem, double volume_mm3) {
  return {static_cast<int>(problem.frame.nodes_mm.size()), static_cast<int>(problem.frame.struts.size()), volume_mm3};
}

}  // namespace

const char* to_string(Termination termination) {
  switch (termination) {
    case Termination::kOptimal: return "optimal";
    case Termination::kInfeasible: return "infeasible";
    case Termination::kIterationLimit: return "iteration_limit";
  }
  return "unknown";
}

Status OptimizeOptions::validate() const {
  const auto require = [](bool holds, const char* what) -> Status {
    return holds ? ok_status() : Status(invalid_input(fmt::format("optimize options: {}", what)));
  };
  for (const Status& status :
       {require(kkt_tolerance > 0 && kkt_tolerance <= 1e-3, "kkt_tolerance must lie in (0, 1e-3]"),
        require(max_interior_point_iterations > 0, "max_interior_point_iterations must be positive"),
        require(feasibility_tolerance > 0 && feasibility_tolerance <= 1e-2, "feasibility_tolerance must lie in (0, 1e-2]"),
        require(outer_decrease >= 0 && outer_decrease < 1, "outer_decrease must lie in [0, 1)"),
        require(max_outer_iterations > 0, "max_outer_iterations must be positive"),
        require(topology_cap_room > 0 && topology_cap_room < 1, "topology_cap_room must lie in (0, 1)"),
        require(topology_reweightings > 0, "topology_reweightings must be positive"),
        require(topology_xi > 0 && topology_xi <= 1, "topology_xi must lie in (0, 1]"),
        require(relaxed_removal_share > 0 && relaxed_removal_share < 1, "relaxed_removal_share must lie in (0, 1)"),
        require(topology_removal_share > 0 && topology_removal_share < 1, "topology_removal_share must lie in (0, 1)"),
        require(max_geometry_passes > 0, "max_geometry_passes must be positive"),
        require(geometry_decrease >= 0 && geometry_decrease < 1, "geometry_decrease must lie in [0, 1)"),
        require(region_share > 0 && region_share < 0.5, "region_share must lie in (0, 0.5)"),
        require(min_length_mm >= 0, "min_length_mm must not be negative"),
        require(max_move_halvings >= 0, "max_move_halvings must not be negative")})
    if (!status.ok()) return status;
  return ok_status();
}

Result<OptimizeResult> optimize_frame(const FrameProblem& problem, const OptimizeOptions& options, RunContext& context) {
  if (Status s = validate(problem); !s.ok()) return s.error();
  if (Status s = options.validate(); !s.ok()) return s.error();
  use_one_blas_thread();
  Session session(options, context);
  SizedFrame sized = size_frame(problem, {}, session);
  if (sized.cancelled) return cancelled_error();
  OptimizeResult result;
  result.reason = sized.reason;
  result.detail = sized.detail;
  result.problem = problem;
  result.radii_mm = radii_of(sized.areas_mm2);
  result.evaluation = sized.evaluation;
  result.size = record_of(problem, sized.volume_mm3());
  result.kkt_residual = sized.kkt_error;
  result.interior_point_iterations = session.interior_point_iterations();
  return result;
}

}  // namespace skinframe
