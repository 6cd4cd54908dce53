// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/algorithm_state.h"

#include <algorithm>

#include "worker/mechanics/problem_bytes.h"
#include "worker/run/bytes.h"

namespace skinframe {

template <class Archive>
void pass(Archive& archive, WarmStart& warm) {
  archive(warm.cases, warm.multipliers, warm.displacement_duals);
}

template <class Archive>
void pass(Archive& archive, SolverEffort& effort) {
  archive(effort.iterations, effort.factorisations, effort.seconds);
}

template <class Archive>
void pass(Archive& archive, SessionState& session) {
  archive(session.effort, session.offered, session.latest, session.most_mm3);
}

template <class Archive>
void pass(Archive& archive, Design& design) {
  archive(design.problem, design.areas_mm2, design.volume_mm3, design.reason, design.detail, design.kkt_error,
          design.warm, design.node_origin, design.strut_origin);
}

template <class Archive>
void pass(Archive& archive, StageRecord& record) {
  archive(record.nodes, record.struts, record.volume_mm3, record.radii_mm, record.lengths_mm);
}

template <class Archive>
void pass(Archive& archive, VirtualField& field) {
  archive(field.load_case, field.displacement_multiplier, field.stress_multiplier, field.displacements_mm);
}

template <class Archive>
void pass(Archive& archive, DualProof& proof) {
  archive(proof.volume_weight, proof.fields, proof.balance_multipliers, proof.feasibility_tolerance);
}

template <class Archive>
void pass(Archive& archive, OuterLoop& loop) {
  archive(loop.round, loop.after_topology, loop.settled, loop.ended, loop.volume_before_mm3,
          loop.struts_before);
}

template <class Archive>
void pass(Archive& archive, AlgorithmState& state) {
  OptimizeResult& r = state.so_far;
  archive(state.loop, state.design, state.session, r.initial, r.size, r.topology, r.geometry,
          r.outer_iterations, r.lower_bound_mm3, r.gap, r.relaxed_lower_bound_mm3, r.relaxed_gap,
          r.lower_bound_proof, r.relaxed_lower_bound_proof, r.seconds);
}

template <class Archive>
void pass(Archive& archive, OptimizeOptions& o) {
  bool regions = static_cast<bool>(o.convex_regions), accepts = static_cast<bool>(o.accepts);
  archive(o.order, o.relaxed, o.topology, o.geometry, regions, accepts, o.bounds, o.hint_radii_mm,
          o.kkt_tolerance, o.max_interior_point_iterations, o.feasibility_tolerance, o.outer_decrease,
          o.max_outer_iterations, o.topology_cap_room, o.topology_reweightings, o.topology_xi,
          o.relaxed_removal_share, o.topology_removal_share, o.max_geometry_passes, o.geometry_decrease,
          o.region_share, o.merge_share, o.min_length_mm, o.max_move_halvings);
}

namespace {

bool within(const std::vector<int>& indices, std::size_t count) {
  return std::all_of(indices.begin(), indices.end(),
                     [&](int i) { return i >= 0 && static_cast<std::size_t>(i) < count; });
}

bool is_consistent(const WarmStart& warm, std::size_t load_cases) {
  if (warm.multipliers.size() != warm.cases.size() || warm.displacement_duals.size() != warm.cases.size())
    return false;
  for (std::size_t i = 0; i < warm.cases.size(); ++i)
    if (warm.multipliers[i].size() != warm.multipliers[0].size() ||
        warm.displacement_duals[i].size() != warm.multipliers[0].size())
      return false;
  return within(warm.cases, load_cases);
}

bool is_consistent(const AlgorithmState& state, const FrameProblem& given) {
  const Design& design = state.design;
  const Frame& frame = design.problem.frame;
  const std::size_t cases = given.load_cases.size();
  return validate(design.problem).ok() && design.problem.load_cases.size() == cases &&
         design.areas_mm2.size() == frame.struts.size() &&
         design.strut_origin.size() == frame.struts.size() &&
         design.node_origin.size() == frame.nodes_mm.size() &&
         within(design.strut_origin, given.frame.struts.size()) &&
         within(design.node_origin, given.frame.nodes_mm.size()) && is_consistent(design.warm, cases) &&
         is_consistent(state.session.offered, cases) && is_consistent(state.session.latest, cases) &&
         state.loop.round >= 0;
}

}  // namespace

std::string algorithm_key(const FrameProblem& problem, const OptimizeOptions& options) {
  ByteWriter bytes;
  FrameProblem own_problem = problem;
  OptimizeOptions own_options = options;
  bytes(own_problem, own_options);
  return "optimize/" + fingerprint(bytes.take());
}

std::string to_bytes(AlgorithmState& state) {
  ByteWriter bytes;
  bytes(state);
  return bytes.take();
}

std::optional<AlgorithmState> algorithm_state(std::string_view bytes, const FrameProblem& problem) {
  AlgorithmState state;
  ByteReader reader(bytes);
  reader(state);
  if (!reader.complete() || !is_consistent(state, problem)) return std::nullopt;
  return state;
}

}  // namespace skinframe
