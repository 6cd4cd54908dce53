// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/topology_stage.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "worker/optimize/restore_struts.h"
#include "worker/optimize/size_frame.h"

namespace skinframe {
namespace {

// A load case takes part when its demand is at least this share of the limit in the sized frame.
constexpr double kBindingShare = 0.95;
// The printed order caps the volume at SizeOpt's; rounding must not make that infeasible.
constexpr double kPaperCapRoom = 1e-6;
// What is thresholded and sized again need not be exact; and a program that does not converge soon is not
// worth waiting for.
constexpr double kRoughly = 100;
constexpr int kPatientIterations = 80;
// With duals, but other bounds.
constexpr double kNearBarrier = 1e-2;
// xi of the weights that stand for lower bounds, of the mean area.
constexpr double kRoundingXi = 0.1;

std::vector<int> binding_cases(const Design& design) {
  const std::vector<double> radii = radii_of(design.areas_mm2);
  const std::vector<CaseResponse> responses = solve_equilibrium(design.problem, design.areas_mm2);
  std::vector<int> binding;
  int critical = -1;
  double worst = -1;
  for (int k = 0; k < static_cast<int>(responses.size()); ++k) {
    const double demand = utilisation(evaluate(design.problem, radii, {responses[k]}));
    if (demand >= kBindingShare) binding.push_back(k);
    if (demand > worst) worst = demand, critical = k;
  }
  if (binding.empty() && critical >= 0) binding.push_back(critical);
  return binding;
}

// Bounds in which removable struts may shrink to nothing.
ProgramRequest removal_request(const Design& design) {
  ProgramRequest request;
  set_size_bounds(design.problem, request);
  request.cases = binding_cases(design);
  request.tolerance_factor = kRoughly;
  request.max_iterations = kPatientIterations;
  const std::vector<bool> removable = removable_struts(design.problem);
  for (std::size_t j = 0; j < removable.size(); ++j)
    if (removable[j]) request.lower_mm2[j] = 0;
  return request;
}

double volume_of(const Frame& frame, const std::vector<double>& areas_mm2) {
  double volume = 0;
  for (std::size_t j = 0; j < areas_mm2.size(); ++j)
    volume += frame.length_mm(frame.struts[j]) * areas_mm2[j];
  return volume;
}

std::optional<Design> bare_design(const Design& design, const OptimizeOptions& options) {
  std::vector<bool> keep = removable_struts(design.problem);
  keep.flip();
  if (std::none_of(keep.begin(), keep.end(), [](bool kept) { return kept; })) return std::nullopt;
  if (std::all_of(keep.begin(), keep.end(), [](bool kept) { return kept; })) return std::nullopt;
  Design bare = reduced_design(design, keep);
  ProgramRequest bounds;
  set_size_bounds(bare.problem, bounds);
  const Evaluation evaluation = evaluate(bare.problem, radii_of(bounds.lower_mm2));
  if (!is_feasible(evaluation, options) || evaluation.frame_volume_mm3 > (1 + kVolumeTie) * design.volume_mm3)
    return std::nullopt;
  bare.areas_mm2 = std::move(bounds.lower_mm2);
  bare.volume_mm3 = evaluation.frame_volume_mm3;
  bare.reason = Termination::kOptimal;
  bare.detail = "no removable strut is needed, and every other one stands at its lower bound";
  bare.kkt_error = 0;
  return bare;
}

// The cost of a removable strut's volume is that of its lower bound as soon as it is there.
std::vector<double> rounding_weights(const Design& design, const std::vector<double>& areas_mm2) {
  const std::vector<bool> removable = removable_struts(design.problem);
  const Frame& frame = design.problem.frame;
  const double xi = kRoundingXi * mean_area_mm2(design.areas_mm2);
  double mean_length = 0;
  for (const Strut& strut : frame.struts)
    mean_length += frame.length_mm(strut) / static_cast<double>(frame.struts.size());
  std::vector<double> weights;
  for (int j = 0; j < static_cast<int>(areas_mm2.size()); ++j) {
    const double lower = area_bounds(design.problem, j).lower_mm2;
    const double rounding = removable[j] ? std::max(1.0, (lower + xi) / (areas_mm2[j] + xi)) : 1.0;
    weights.push_back(rounding * frame.length_mm(frame.struts[j]) / mean_length);
  }
  return weights;
}

// Sets `bound_mm3` to the relaxed optimum where that was reached.
Design relax(Design design, bool rounded_up, double& bound_mm3, Session& session) {
  ProgramRequest least = removal_request(design);
  least.warm = design.warm;
  if (!least.warm.empty()) least.initial_barrier = kNearBarrier;
  ProgramOutcome outcome = session.solve(design.problem, std::move(least), design.areas_mm2);
  if (outcome.end == InteriorPointEnd::kCancelled) return design;
  if (outcome.converged()) {
    bound_mm3 = volume_of(design.problem.frame, outcome.areas_mm2);
    design.warm = outcome.warm;
  }
  if (outcome.converged() && rounded_up) {
    ProgramRequest request = removal_request(design);
    request.area_weights = rounding_weights(design, outcome.areas_mm2);
    session.offer(design.warm);
    ProgramOutcome rounded = session.solve(design.problem, std::move(request), outcome.areas_mm2);
    session.offer({});
    if (rounded.end == InteriorPointEnd::kCancelled) return design;
    if (rounded.converged()) {
      outcome = std::move(rounded);
      design.warm = outcome.warm;
    }
  }
  auto fewer =
      without_thin_struts(design, outcome.areas_mm2, session.options().relaxed_removal_share, session);
  return fewer ? std::move(*fewer) : design;
}

// Every program starts from the sized frame, which has the whole room under the cap: the areas of the one
// before stand on the cap, and a start there crawls along it.
Design reweight(Design design, double cap_room, Session& session) {
  const OptimizeOptions& options = session.options();
  const std::vector<bool> removable = removable_struts(design.problem);
  if (std::none_of(removable.begin(), removable.end(), [](bool may_go) { return may_go; })) return design;
  const double xi = options.topology_xi * mean_area_mm2(design.areas_mm2);
  std::vector<double> areas = design.areas_mm2;
  for (int round = 0; round < options.topology_reweightings; ++round) {
    ProgramRequest request = removal_request(design);
    request.volume_cap_mm3 = (1 + cap_room) * design.volume_mm3;
    request.area_weights.assign(areas.size(), 0);
    for (std::size_t j = 0; j < areas.size(); ++j)
      if (removable[j]) request.area_weights[j] = xi / (xi + areas[j]);
    const ProgramOutcome outcome = session.solve(design.problem, request, design.areas_mm2);
    if (outcome.end == InteriorPointEnd::kCancelled) return design;
    if (!outcome.converged()) break;  // the areas of the round before still serve
    areas = outcome.areas_mm2;
  }
  auto fewer = without_thin_struts(design, areas, options.topology_removal_share, session);
  return fewer ? std::move(*fewer) : design;
}

}  // namespace

Design optimise_topology(Design design, bool rounded_up, Session& session) {
  if (auto bare = bare_design(design, session.options())) return std::move(*bare);
  const OptimizeOptions& options = session.options();
  const bool tight = options.order == OptimizeOptions::Order::kTight;
  double bound_mm3 = 0;
  if (tight && options.relaxed) design = relax(std::move(design), rounded_up, bound_mm3, session);
  if (!options.topology || session.cancelled()) return design;
  if (design.volume_mm3 <= (1 + kNoRoom) * bound_mm3) return design;
  return reweight(std::move(design), tight ? options.topology_cap_room : kPaperCapRoom, session);
}

}  // namespace skinframe
