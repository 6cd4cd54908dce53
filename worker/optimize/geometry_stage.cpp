// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/geometry_stage.h"

#include <algorithm>
#include <limits>
#include <numbers>
#include <optional>

#include "worker/optimize/size_frame.h"

namespace skinframe {
namespace {

using Eigen::Vector3d;

constexpr double kNearBarrier = 1e-2;
// The moved frame is sized again: the pass itself need not be exact, nor be waited for when it does not
// converge.
constexpr double kRoughly = 10;
constexpr int kPatientIterations = 80;
// A node this close to the edge of its region, relative to its box, does not move in this pass.
constexpr double kEdgeShare = 1e-3;
// The least length is at most this share of the present one, so that the start is inside.
constexpr double kLeastLengthShare = 0.98;
constexpr double kDefaultLengthShare = 0.5;

std::vector<double> distance_to_nearest(const Frame& frame, const std::vector<bool>& wanted) {
  std::vector<double> distance(frame.nodes_mm.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < distance.size(); ++i) {
    if (!wanted[i]) continue;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < distance.size(); ++k)
      if (k != i) nearest = std::min(nearest, (frame.nodes_mm[k] - frame.nodes_mm[i]).squaredNorm());
    distance[i] = std::sqrt(nearest);
  }
  return distance;
}

// The regions of the nodes that move in this pass: the caller's half-spaces and the box of the move limit.
NodeRegions regions_of(const Design& design, const OptimizeOptions& options) {
  const FrameProblem& problem = design.problem;
  const Frame& frame = problem.frame;
  NodeRegions given;
  if (options.convex_regions) given = options.convex_regions(frame, radii_of(design.areas_mm2));
  const std::vector<double> nearest = distance_to_nearest(frame, problem.free_nodes);
  NodeRegions regions(frame.nodes_mm.size());
  bool any = false;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    if (!problem.free_nodes[i]) continue;
    const double half_width = options.region_share * nearest[i];
    std::vector<HalfSpace> region;
    if (i < given.size()) region = given[i];
    if (options.convex_regions && region.empty()) continue;  // the caller lets it stand
    const Vector3d& at = frame.nodes_mm[i];
    const bool inside = std::all_of(region.begin(), region.end(), [&](const HalfSpace& space) {
      return space.normal.dot(at) <= space.offset_mm - kEdgeShare * half_width;
    });
    if (!inside) continue;
    for (int axis = 0; axis < 3; ++axis)
      for (double sign : {-1.0, 1.0})
        region.push_back({sign * Vector3d::Unit(axis), sign * at[axis] + half_width});
    regions[i] = std::move(region);
    any = true;
  }
  return any ? regions : NodeRegions{};
}

ProgramRequest geometry_request(const Design& design, NodeRegions regions, const OptimizeOptions& options) {
  const FrameProblem& problem = design.problem;
  ProgramRequest request;
  set_size_bounds(problem, request);
  request.initial_barrier = kNearBarrier;
  request.tolerance_factor = kRoughly;
  request.max_iterations = kPatientIterations;
  for (std::size_t j = 0; j < problem.frame.struts.size(); ++j) {
    const Strut& strut = problem.frame.struts[j];
    const double length = problem.frame.length_mm(strut);
    const double least = options.min_length_mm > 0 ? options.min_length_mm : kDefaultLengthShare * length;
    request.min_length_mm.push_back(std::min(least, kLeastLengthShare * length));
    const bool moves = !regions[strut.a].empty() || !regions[strut.b].empty();
    if (moves)  // slenderness is a constraint of its own there
      request.lower_mm2[j] = std::numbers::pi * problem.bounds[j].min_mm * problem.bounds[j].min_mm;
  }
  const std::vector<CaseResponse> responses = solve_equilibrium(problem, design.areas_mm2);
  double worst = -1;
  for (int k = 0; k < static_cast<int>(responses.size()); ++k) {
    const double demand = utilisation(evaluate(problem, radii_of(design.areas_mm2), {responses[k]}));
    if (demand > worst) worst = demand, request.cases = {k};
  }
  request.regions = std::move(regions);
  return request;
}

// The moved frame, sized and accepted, with the move shortened until it is.
std::optional<Design> settle(const Design& design, const ProgramOutcome& outcome, Session& session) {
  double share = 1;
  for (int halving = 0; halving <= session.options().max_move_halvings; ++halving, share /= 2) {
    Design moved = design;
    for (std::size_t i = 0; i < moved.problem.frame.nodes_mm.size(); ++i)
      moved.problem.frame.nodes_mm[i] += share * (outcome.positions_mm[i] - design.problem.frame.nodes_mm[i]);
    SizedFrame sized = size_frame(moved.problem, outcome.areas_mm2, session);
    if (sized.cancelled) return std::nullopt;
    if (!sized.feasible() || !(sized.volume_mm3() < design.volume_mm3)) continue;
    const auto& accepts = session.options().accepts;
    if (accepts && !accepts(moved.problem.frame, radii_of(sized.areas_mm2))) continue;
    take_sizing(moved, std::move(sized));
    return moved;
  }
  return std::nullopt;
}

}  // namespace

Design optimise_geometry(Design design, Session& session) {
  const OptimizeOptions& options = session.options();
  for (int pass = 0; pass < options.max_geometry_passes; ++pass) {
    if (design.problem.free_nodes.empty()) break;
    NodeRegions regions = regions_of(design, options);
    if (regions.empty()) break;
    const ProgramOutcome outcome = session.solve(
        design.problem, geometry_request(design, std::move(regions), options), design.areas_mm2);
    if (outcome.end == InteriorPointEnd::kCancelled) break;
    const double before = design.volume_mm3;
    auto moved = settle(design, outcome, session);
    if (!moved) break;
    design = std::move(*moved);
    if (design.volume_mm3 > (1 - options.geometry_decrease) * before) break;
  }
  return design;
}

}  // namespace skinframe
