// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/geometry_stage.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <numbers>
#include <optional>

#include "worker/optimize/merge_nodes.h"
#include "worker/optimize/restore_struts.h"
#include "worker/optimize/size_frame.h"

namespace skinframe {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kNearBarrier = 1e-2;
// The moved frame is sized again: the pass itself need not be exact, nor be waited for when it does not
// converge.
constexpr double kRoughly = 100;
constexpr int kPatientIterations = 80;
// A node this close to the edge of its region, relative to its reach, does not move in this pass.
constexpr double kEdgeShare = 1e-3;
// The least length is at most this share of the present one, so that the start is inside.
constexpr double kLeastLengthShare = 0.98;
constexpr double kDefaultLengthShare = 0.5;
// A load case that took no part joins when the moved frame exceeds its limits by this, relative.
constexpr double kCaseExcess = 1e-3;
// Squares of sines: below, struts are in line; and by how much a strut must be more across than the one
// before, so that rounding does not choose between two that are alike.
constexpr double kInLine = 1e-6, kClearlyMore = 1e-6;
// Sets of contractions tried after one pass.
constexpr int kMostContractions = 6;

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

// Three axes of each node from its own struts, so that the box of the move limit turns with the frame: the
// first strut's direction, the part across it of the strut that is most across, and their cross product. Any
// axes serve a node whose struts are all in line.
std::vector<Matrix3d> strut_axes(const Frame& frame) {
  std::vector<Vector3d> along(frame.nodes_mm.size(), Vector3d::Zero()), across = along;
  const auto at_each_end = [&](auto act) {
    for (const Strut& strut : frame.struts) {
      const Vector3d e = (frame.nodes_mm[strut.b] - frame.nodes_mm[strut.a]).normalized();
      act(strut.a, e);
      act(strut.b, Vector3d(-e));
    }
  };
  at_each_end([&](int node, const Vector3d& e) {
    if (along[node].isZero()) along[node] = e;
  });
  at_each_end([&](int node, const Vector3d& e) {
    const Vector3d part = e - e.dot(along[node]) * along[node];
    if (part.squaredNorm() > (1 + kClearlyMore) * across[node].squaredNorm()) across[node] = part;
  });
  std::vector<Matrix3d> axes(along.size(), Matrix3d::Identity());
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (across[i].squaredNorm() < kInLine) continue;
    axes[i].col(0) = along[i];
    axes[i].col(1) = across[i].normalized();
    axes[i].col(2) = axes[i].col(0).cross(axes[i].col(1));
  }
  return axes;
}

// The regions of the nodes that move in this pass: the caller's half-spaces, and the box of the move limit.
NodeRegions regions_of(const Design& design, const OptimizeOptions& options) {
  const FrameProblem& problem = design.problem;
  const Frame& frame = problem.frame;
  NodeRegions given;
  if (options.convex_regions) given = options.convex_regions(frame, radii_of(design.areas_mm2));
  const std::vector<double> nearest = distance_to_nearest(frame, problem.free_nodes);
  const std::vector<Matrix3d> axes = strut_axes(frame);
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
      for (double sign : {-1.0, 1.0}) {
        const Vector3d normal = sign * axes[i].col(axis);
        region.push_back({normal, normal.dot(at) + half_width});
      }
    regions[i] = std::move(region);
    any = true;
  }
  return any ? regions : NodeRegions{};
}

// Demand over limit of each load case.
std::vector<double> demands(const FrameProblem& problem, const std::vector<double>& areas_mm2) {
  std::vector<double> result;
  const std::vector<double> radii = radii_of(areas_mm2);
  for (const CaseResponse& response : solve_equilibrium(problem, areas_mm2))
    result.push_back(utilisation(evaluate(problem, radii, {response})));
  return result;
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
  request.regions = std::move(regions);
  return request;
}

Design moved_design(const Design& design, const ProgramOutcome& outcome, double share) {
  Design moved = design;
  for (std::size_t i = 0; i < moved.problem.frame.nodes_mm.size(); ++i)
    moved.problem.frame.nodes_mm[i] += share * (outcome.positions_mm[i] - design.problem.frame.nodes_mm[i]);
  if (!outcome.warm.empty()) moved.warm = outcome.warm;
  return moved;
}

bool accepted(const Design& design, const std::vector<double>& areas_mm2, const OptimizeOptions& options) {
  return !options.accepts || options.accepts(design.problem.frame, radii_of(areas_mm2));
}

// The moved frame, sized and accepted, with the move shortened until it is.
std::optional<Design> settle(const Design& design, const ProgramOutcome& outcome, Session& session) {
  const OptimizeOptions& options = session.options();
  double share = 1;
  for (int halving = 0; halving <= options.max_move_halvings; ++halving, share /= 2) {
    Design moved = moved_design(design, outcome, share);
    if (!accepted(moved, outcome.areas_mm2, options)) continue;  // sizing would hardly mend that
    const bool smaller = size_again(moved, outcome.areas_mm2, design.volume_mm3, session);
    if (session.cancelled()) return std::nullopt;
    if (!smaller || !(moved.volume_mm3 < design.volume_mm3)) continue;
    if (accepted(moved, moved.areas_mm2, options)) return moved;
  }
  return std::nullopt;
}

// One pass; `cases` are those that took part so far.
std::optional<Design> moved_once(const Design& design, std::vector<int>& cases, Session& session) {
  NodeRegions regions = regions_of(design, session.options());
  if (regions.empty()) return std::nullopt;
  ProgramRequest request = geometry_request(design, std::move(regions), session.options());
  for (;;) {
    request.cases = cases;
    session.offer(design.warm);
    const ProgramOutcome outcome = session.solve(design.problem, request, design.areas_mm2);
    session.offer({});
    if (outcome.end == InteriorPointEnd::kCancelled) return std::nullopt;
    const std::vector<double> demand = demands(moved_design(design, outcome, 1).problem, outcome.areas_mm2);
    const std::size_t before = cases.size();
    for (int k = 0; k < static_cast<int>(demand.size()); ++k)
      if (demand[k] > 1 + kCaseExcess && std::find(cases.begin(), cases.end(), k) == cases.end())
        cases.push_back(k);
    if (cases.size() == before) return settle(design, outcome, session);
  }
}

// Contracts what has become short: all at once, then half as many, shortest first, until the sized result is
// no larger.
Design merged(Design design, Session& session) {
  const OptimizeOptions& options = session.options();
  std::vector<int> chosen = contractible_struts(design, options.merge_share);
  for (int attempt = 0; attempt < kMostContractions && !chosen.empty(); ++attempt) {
    auto fewer = contracted_design(design, chosen);
    if (fewer) {
      const std::vector<double> hint = fewer->areas_mm2;
      if (size_again(*fewer, hint, (1 + kVolumeTie) * design.volume_mm3, session) &&
          accepted(*fewer, fewer->areas_mm2, options))
        return std::move(*fewer);
      if (session.cancelled()) return design;
    }
    chosen.resize(chosen.size() / 2);
  }
  return design;
}

}  // namespace

GeometryOutcome optimise_geometry(Design design, Session& session) {
  const OptimizeOptions& options = session.options();
  if (design.problem.free_nodes.empty()) return {std::move(design), true};
  const std::vector<double> demand = demands(design.problem, design.areas_mm2);
  std::vector<int> cases;
  if (!demand.empty())
    cases.push_back(static_cast<int>(std::max_element(demand.begin(), demand.end()) - demand.begin()));
  for (int pass = 0; pass < options.max_geometry_passes; ++pass) {
    const double before = design.volume_mm3;
    auto moved = moved_once(design, cases, session);
    if (session.cancelled() || !moved) return {std::move(design), true};
    design = merged(std::move(*moved), session);
    if (session.cancelled() || design.volume_mm3 > (1 - options.geometry_decrease) * before)
      return {std::move(design), true};
  }
  return {std::move(design), false};
}

}  // namespace skinframe
