// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/topology_stage.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "worker/optimize/size_frame.h"

namespace skinframe {
namespace {

// A load case takes part when its demand is at least this share of the limit in the sized frame.
constexpr double kBindingShare = 0.95;
// Shares of the removed struts that come back, try after try.
constexpr double kRestored[] = {0.0, 0.2};
// A strut with lower bound zero is removed at this share of the mean area.
constexpr double kVanishedShare = 1e-4;
// The printed order caps the volume at SizeOpt's; rounding must not make that infeasible.
constexpr double kPaperCapRoom = 1e-6;
constexpr double kNearBarrier = 1e-2;
// What is thresholded and sized again need not be exact; and a program that does not converge soon is not
// worth waiting for.
constexpr double kRoughly = 10;
constexpr int kPatientIterations = 80;

double mean_area(const Design& design) {
  return std::accumulate(design.areas_mm2.begin(), design.areas_mm2.end(), 0.0) /
         static_cast<double>(design.areas_mm2.size());
}

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

// Bounds know the clearance of nodes where they first stood. Once geometry has moved them, a strut that grows
// may leave what the caller accepts.
bool loses_acceptance(const Design& before, const Frame& frame, const std::vector<double>& areas_mm2,
                      const OptimizeOptions& options) {
  const auto& accepts = options.accepts;
  return accepts && !accepts(frame, radii_of(areas_mm2)) &&
         accepts(before.problem.frame, radii_of(before.areas_mm2));
}

// The sized frame without the struts whose area fell to `share` of their lower bound, if it is feasible and
// not larger.
std::optional<Design> threshold_and_size(const Design& design, const std::vector<double>& areas_mm2,
                                         double share, Session& session) {
  const std::vector<bool> removable = removable_struts(design.problem);
  const double vanished = kVanishedShare * mean_area(design);
  std::vector<bool> keep(removable.size(), true);
  std::vector<int> removed;
  for (int j = 0; j < static_cast<int>(removable.size()); ++j) {
    const double lower = area_bounds(design.problem, j).lower_mm2;
    if (!removable[j] || areas_mm2[j] > std::max(share * lower, vanished)) continue;
    keep[j] = false;
    removed.push_back(j);
  }
  if (removed.empty()) return std::nullopt;
  std::stable_sort(removed.begin(), removed.end(), [&](int a, int b) { return areas_mm2[a] > areas_mm2[b]; });

  std::size_t tried = 0;  // struts of the try before
  for (double restored : kRestored) {
    const auto back = static_cast<std::size_t>(restored * static_cast<double>(removed.size()));
    for (std::size_t r = 0; r < back; ++r) keep[removed[r]] = true;
    Design shrunk = design;
    shrunk.areas_mm2 = areas_mm2;
    shrunk = reduced_design(shrunk, keep);
    const std::size_t struts = shrunk.problem.frame.struts.size();
    if (struts == 0 || struts == tried) continue;
    tried = struts;
    SizedFrame sized = size_frame(shrunk.problem, shrunk.areas_mm2, session);
    if (sized.cancelled) return std::nullopt;
    if (!sized.feasible() || sized.volume_mm3() > (1 + kVolumeTie) * design.volume_mm3) continue;
    if (loses_acceptance(design, shrunk.problem.frame, sized.areas_mm2, session.options())) continue;
    take_sizing(shrunk, std::move(sized));
    return shrunk;
  }
  return std::nullopt;
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

Design relax(Design design, Session& session) {
  const ProgramOutcome outcome = session.solve(design.problem, removal_request(design), design.areas_mm2);
  if (outcome.end == InteriorPointEnd::kCancelled) return design;
  auto shrunk =
      threshold_and_size(design, outcome.areas_mm2, session.options().relaxed_removal_share, session);
  return shrunk ? std::move(*shrunk) : design;
}

Design reweight(Design design, double cap_room, Session& session) {
  const OptimizeOptions& options = session.options();
  const std::vector<bool> removable = removable_struts(design.problem);
  if (std::none_of(removable.begin(), removable.end(), [](bool may_go) { return may_go; })) return design;
  const double xi = options.topology_xi * mean_area(design);
  std::vector<double> areas = design.areas_mm2;
  for (int round = 0; round < options.topology_reweightings; ++round) {
    ProgramRequest request = removal_request(design);
    request.volume_cap_mm3 = (1 + cap_room) * design.volume_mm3;
    request.initial_barrier = kNearBarrier;
    request.area_weights.assign(areas.size(), 0);
    for (std::size_t j = 0; j < areas.size(); ++j)
      if (removable[j]) request.area_weights[j] = xi / (xi + areas[j]);
    const ProgramOutcome outcome = session.solve(design.problem, request, areas);
    if (outcome.end == InteriorPointEnd::kCancelled) return design;
    if (!outcome.converged()) break;  // the areas of the round before still serve
    areas = outcome.areas_mm2;
  }
  auto shrunk = threshold_and_size(design, areas, options.topology_removal_share, session);
  return shrunk ? std::move(*shrunk) : design;
}

}  // namespace

Design optimise_topology(Design design, Session& session) {
  if (auto bare = bare_design(design, session.options())) return std::move(*bare);
  const OptimizeOptions& options = session.options();
  const bool tight = options.order == OptimizeOptions::Order::kTight;
  if (tight && options.relaxed) design = relax(std::move(design), session);
  if (!options.topology || session.cancelled()) return design;
  return reweight(std::move(design), tight ? options.topology_cap_room : kPaperCapRoom, session);
}

}  // namespace skinframe
