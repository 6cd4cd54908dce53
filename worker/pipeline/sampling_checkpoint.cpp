// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/pipeline/sampling_checkpoint.h"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "worker/mechanics/problem_bytes.h"

namespace skinframe {

template <class Archive>
void pass(Archive& archive, TriangleAngles& angles) {
  archive(angles.mean, angles.first_percentile, angles.least);
}

template <class Archive>
void pass(Archive& archive, Opening& opening) {
  archive(opening.centre_mm, opening.axis, opening.radius_mm, opening.rise_mm, opening.clear_mm);
}

template <class Archive>
void pass(Archive& archive, SampledFrame& sampled) {
  archive(sampled.frame, sampled.contact_nodes, sampled.skin_nodes_requested, sampled.skin_nodes_sampled,
          sampled.finger_edge_mm, sampled.mean_skin_edge_mm, sampled.worst_outward_chord_mm,
          sampled.worst_inward_chord_mm, sampled.skin_struts_outside, sampled.struts_left_out_crossing,
          sampled.angles, sampled.pieces, sampled.openings, sampled.warnings);
}

template <class Archive>
void pass(Archive& archive, SamplingFacts& facts) {
  archive(facts.density, facts.skin_nodes_requested, facts.skin_nodes_sampled, facts.skin_nodes,
          facts.internal_nodes, facts.angles, facts.worst_outward_chord_mm, facts.worst_inward_chord_mm,
          facts.skin_struts_outside, facts.struts_left_out_crossing, facts.stress_tetrahedra,
          facts.stress_largest_mpa);
}

namespace {

struct SamplingState {
  SampledFrame sampled;
  SamplingFacts facts;
  std::vector<std::string> warnings;  // that sampling added to the report
  std::map<std::string, double> seconds;
};

template <class Archive>
void pass(Archive& archive, SamplingState& state) {
  archive(state.sampled, state.facts, state.warnings, state.seconds);
}

bool is_consistent(const SampledFrame& sampled) {
  const Frame& frame = sampled.frame;
  const int nodes = static_cast<int>(frame.nodes_mm.size());
  const auto is_node = [nodes](int i) { return i >= 0 && i < nodes; };
  return frame.skin_node_count >= 0 && frame.skin_node_count <= nodes &&
         std::all_of(frame.nodes_mm.begin(), frame.nodes_mm.end(),
                     [](const Eigen::Vector3d& node) { return node.allFinite(); }) &&
         std::all_of(frame.struts.begin(), frame.struts.end(),
                     [&](const Strut& s) { return is_node(s.a) && is_node(s.b) && s.a != s.b; }) &&
         std::all_of(frame.skin_triangles.begin(), frame.skin_triangles.end(),
                     [&](const std::array<int, 3>& t) { return std::all_of(t.begin(), t.end(), is_node); }) &&
         std::all_of(sampled.contact_nodes.begin(), sampled.contact_nodes.end(), is_node);
}

}  // namespace

Result<SampledFrame> sample_or_go_on(const std::string& key,
                                     const std::function<Result<SampledFrame>()>& sample,
                                     PrinterReport* report, Checkpoints* checkpoints) {
  if (const auto bytes = checkpoints != nullptr ? checkpoints->find(key) : std::nullopt) {
    SamplingState state;
    ByteReader reader(*bytes);
    reader(state);
    if (reader.complete() && is_consistent(state.sampled)) {
      checkpoints->used(to_string(Stage::kSample));
      report->sampling = state.facts;
      report->warnings.insert(report->warnings.end(), state.warnings.begin(), state.warnings.end());
      report->seconds.insert(state.seconds.begin(), state.seconds.end());
      return std::move(state.sampled);
    }
    checkpoints->refused("the sampled frame is damaged");
  }
  const std::size_t warnings_before = report->warnings.size();
  auto sampled = sample();
  if (!sampled || checkpoints == nullptr) return sampled;
  SamplingState state{*sampled, *report->sampling, {}, {}};
  state.warnings.assign(report->warnings.begin() + static_cast<std::ptrdiff_t>(warnings_before),
                        report->warnings.end());
  for (const char* stage : {"stress", "drain", "sample"})
    if (const auto at = report->seconds.find(stage); at != report->seconds.end()) state.seconds.insert(*at);
  ByteWriter bytes;
  bytes(state);
  checkpoints->keep(key, to_string(Stage::kSample), bytes.take());
  return sampled;
}

}  // namespace skinframe
