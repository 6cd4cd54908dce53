// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/frame/sample_frame.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "worker/frame/base_contact.h"
#include "worker/frame/follow_skin.h"
#include "worker/frame/internal_nodes.h"
#include "worker/frame/internal_struts.h"
#include "worker/frame/sample_skin.h"

namespace skinframe {
namespace {

constexpr double kInternalPerSkinNode = 0.35;  // at most; the paper's frames have 0.12 to 0.44
constexpr double kCellOfEdge =
    0.70710678118654752;                 // volume of a node's cell in a^3: nodes packed like spheres
constexpr double kMarginInEdges = 0.25;  // of internal nodes below M1

double mean_skin_edge(const Frame& frame) {
  double sum = 0.0;
  int count = 0;
  for (const Strut& s : frame.struts) {
    if (!s.is_skin) continue;
    sum += frame.length_mm(s);
    ++count;
  }
  return count > 0 ? sum / count : 0.0;
}

void measure_chords(SampledFrame& sampled, const Skin& skin) {
  const Frame& frame = sampled.frame;
  for (const Strut& s : frame.struts) {
    if (!s.is_skin) continue;
    const auto [outward, inward] = chord_deviation(frame.nodes_mm[s.a], frame.nodes_mm[s.b], skin);
    sampled.worst_outward_chord_mm = std::max(sampled.worst_outward_chord_mm, outward);
    sampled.worst_inward_chord_mm = std::max(sampled.worst_inward_chord_mm, inward);
    sampled.skin_struts_outside += outward > skin.thickness_mm;
  }
}

Result<SampledFrame> sample(const Skin& skin, const FrameOptions& options, const RunContext& context) {
  if (skin.inner_surface.triangles.empty()) {
    return invalid_input(
        fmt::format("the body is thinner than two skins ({:.3g} mm) everywhere: there is no room for a "
                    "frame; use a larger --size",
                    2.0 * skin.thickness_mm));
  }
  SampledFrame sampled;
  sampled.finger_edge_mm = finger_edge_mm(options.plate, skin.thickness_mm);
  auto pieces =
      choose_pieces(skin, sampled.finger_edge_mm, options.stress, options.openings, sampled.warnings);
  const auto total = wanted_nodes(pieces, options);
  if (!total) return total.error();
  sampled.skin_nodes_requested = *total;

  const double contact_height = skin.plate_z_mm + skin.thickness_mm + options.contact_tolerance_mm;
  auto sample = sample_skin(pieces, skin, options, *total, contact_height, sampled.warnings, context);
  if (!sample) return sample.error();
  if (!sample->unopened.empty()) {
    SampledFrame none;
    for (const std::size_t k : sample->unopened) none.unopened.push_back(options.openings[k]);
    return none;
  }
  sampled.openings = options.openings;
  sampled.frame = std::move(sample.value().frame);
  sampled.sharp_chords = std::move(sample.value().sharp_chords);
  sampled.skin_nodes_sampled = sample->nodes_sampled;
  sampled.pieces = static_cast<int>(pieces.size());
  sampled.mean_skin_edge_mm = mean_skin_edge(sampled.frame);
  if (sampled.skin_nodes_sampled != *total) {
    sampled.warnings.push_back(
        fmt::format("{} skin nodes sampled instead of {}: the shape of the body needs them",
                    sampled.skin_nodes_sampled, *total));
  }

  const double margin = std::max(2.0 * options.strut_radius_mm, kMarginInEdges * sampled.mean_skin_edge_mm);
  InnerRoom room = find_inner_room(skin, margin);
  std::erase_if(room.samples, [&](const Eigen::Vector3d& p) {
    return room_mm(options.openings, p, p) < 2.0 * options.strut_radius_mm;
  });
  const double cell = kCellOfEdge * std::pow(sampled.mean_skin_edge_mm, 3);
  const int internal = options.internal_nodes.value_or(static_cast<int>(
      std::min(kInternalPerSkinNode * sampled.frame.skin_node_count, room.volume_mm3() / cell)));
  auto inner = spread_nodes(room, internal, skin, context);
  std::erase_if(inner, [&](const Eigen::Vector3d& p) {
    return room_mm(options.openings, p, p) < options.strut_radius_mm;
  });
  if (context.cancelled()) return cancelled_error();
  sampled.frame.nodes_mm.insert(sampled.frame.nodes_mm.end(), inner.begin(), inner.end());
  const auto added = add_internal_struts(
      sampled.frame, {options.strut_radius_mm, options.slenderness, options.neighbours, options.openings},
      skin);
  sampled.struts_left_out_crossing = added.struts_crossing;

  sampled.contact_nodes =
      contact_nodes(sampled.frame.nodes_mm, sampled.frame.skin_node_count, contact_height + kContactSlackMm);
  measure_chords(sampled, skin);
  sampled.angles = measure_angles(sampled.frame);
  if (context.cancelled()) return cancelled_error();
  return sampled;
}

}  // namespace

TriangleAngles measure_angles(const Frame& frame) {
  if (frame.skin_triangles.empty()) return {};
  std::vector<double> least;
  for (const auto& t : frame.skin_triangles) {
    double angle = 180.0;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d& p = frame.nodes_mm[t[k]];
      const Eigen::Vector3d u = frame.nodes_mm[t[(k + 1) % 3]] - p, v = frame.nodes_mm[t[(k + 2) % 3]] - p;
      angle = std::min(angle, std::atan2(u.cross(v).norm(), u.dot(v)) * 180.0 / std::numbers::pi);
    }
    least.push_back(angle);
  }
  std::sort(least.begin(), least.end());
  const double mean = std::accumulate(least.begin(), least.end(), 0.0) / static_cast<double>(least.size());
  return {mean, least[least.size() / 100], least.front()};
}

Status FrameOptions::validate() const {
  const auto outside = [](const char* name, double value, double low, double high) {
    return invalid_input(
        fmt::format("{} {:.6g}: must lie between {:.6g} and {:.6g}", name, value, low, high));
  };
  if (skin_nodes && (*skin_nodes < kMinSkinNodes || *skin_nodes > kMaxSkinNodes)) {
    return outside("--skin-nodes", *skin_nodes, kMinSkinNodes, kMaxSkinNodes);
  }
  if (internal_nodes && (*internal_nodes < 0 || *internal_nodes > kMaxSkinNodes)) {
    return outside("--internal-nodes", *internal_nodes, 0, kMaxSkinNodes);
  }
  if (neighbours < 1 || neighbours > 64) return outside("neighbours", neighbours, 1, 64);
  if (!(plate.tensile_modulus_mpa > 0.0) || !(plate.displacement_limit_mm > 0.0) ||
      !(plate.finger_force_n > 0.0) || !(plate.poisson_ratio >= 0.0 && plate.poisson_ratio < 0.5)) {
    return invalid_input(
        "the finger rule needs a modulus, a displacement limit and a force above 0 and a Poisson ratio "
        "in [0, 0.5)");
  }
  if (!(strut_radius_mm > 0.0)) return invalid_input("the radius of the struts must be above 0");
  if (!(contact_tolerance_mm > 0.0)) return invalid_input("the contact tolerance must be above 0");
  return ok_status();
}

Result<SampledFrame> sample_frame(const Skin& skin, const FrameOptions& options, RunContext& context) {
  if (auto status = options.validate(); !status) return status.error();
  tbb::task_arena arena(std::max(1, context.threads));
  return arena.execute([&] { return sample(skin, options, context); });
}

}  // namespace skinframe
