// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/pipeline/initial_frame.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <fstream>

#include "worker/problem/problem_file.h"
#include "worker/problem/proof_json.h"
#include "worker/run/bytes.h"

namespace skinframe {
namespace {

using nlohmann::json;

json vectors_json(const std::vector<Eigen::Vector3d>& vectors) {
  json list = json::array();
  for (const Eigen::Vector3d& v : vectors) list.push_back({v.x(), v.y(), v.z()});
  return list;
}

json openings_json(const std::vector<Opening>& openings) {
  json list = json::array();
  for (const Opening& opening : openings)
    list.push_back({{"centre_mm", vectors_json({opening.centre_mm})[0]},
                    {"axis", vectors_json({opening.axis})[0]},
                    {"radius_mm", opening.radius_mm},
                    {"rise_mm", opening.rise_mm},
                    {"clear_mm", opening.clear_mm}});
  return list;
}

json reduced_json(const OptimizeResult& result) {
  json struts = json::array();
  for (const Strut& strut : result.problem.frame.struts)
    struts.push_back({strut.a, strut.b, strut.is_skin ? 1 : 0});
  return {{"nodes", vectors_json(result.problem.frame.nodes_mm)},
          {"struts", struts},
          {"radii_mm", result.radii_mm},
          {"volume_mm3", result.evaluation.frame_volume_mm3}};
}

// Thrown and caught within this file only.
[[noreturn]] void refuse(const std::string& field) { throw std::out_of_range(field); }

int index_of(const json& value, std::size_t count, const char* field) {
  const auto index = value.get<std::int64_t>();
  if (index < 0 || static_cast<std::size_t>(index) >= count)
    refuse(fmt::format("{}: {} is none", field, index));
  return static_cast<int>(index);
}

double positive(const json& object, const char* key) {
  const double value = object.at(key).get<double>();
  if (!(std::isfinite(value) && value >= 0)) refuse(fmt::format("{} is {}", key, value));
  return value;
}

Eigen::Vector3d vector_of(const json& value, const char* field) {
  if (value.size() != 3) refuse(field);
  const Eigen::Vector3d v(value[0].get<double>(), value[1].get<double>(), value[2].get<double>());
  if (!v.allFinite()) refuse(field);
  return v;
}

std::vector<Opening> parse_openings(const json& list) {
  constexpr std::size_t kMostOpenings = 1000;
  if (list.size() > kMostOpenings) refuse("sampling.openings has too many");
  std::vector<Opening> openings;
  for (const json& item : list) {
    Opening opening;
    opening.centre_mm = vector_of(item.at("centre_mm"), "sampling.openings.centre_mm");
    opening.axis = vector_of(item.at("axis"), "sampling.openings.axis");
    opening.radius_mm = positive(item, "radius_mm");
    opening.rise_mm = positive(item, "rise_mm");
    opening.clear_mm = positive(item, "clear_mm");
    if (std::abs(opening.axis.norm() - 1.0) > 1e-9 || !(opening.radius_mm > 0.0))
      refuse("sampling.openings: no axis or radius");
    openings.push_back(opening);
  }
  return openings;
}

SampledFrame parse_sampling(const json& sampling, Frame frame) {
  SampledFrame out;
  for (const json& node : sampling.at("contact_nodes"))
    out.contact_nodes.push_back(index_of(node, frame.skin_node_count, "sampling.contact_nodes"));
  if (out.contact_nodes.size() < 3) refuse("sampling.contact_nodes has fewer than three");
  out.skin_nodes_requested = sampling.at("skin_nodes_requested").get<int>();
  out.finger_edge_mm = positive(sampling, "finger_edge_mm");
  out.mean_skin_edge_mm = positive(sampling, "mean_skin_edge_mm");
  out.worst_outward_chord_mm = sampling.at("worst_outward_chord_mm").get<double>();
  out.worst_inward_chord_mm = sampling.at("worst_inward_chord_mm").get<double>();
  out.skin_nodes_sampled = sampling.at("skin_nodes_sampled").get<int>();
  out.struts_left_out_crossing = sampling.at("struts_left_out_crossing").get<int>();
  out.skin_struts_outside = sampling.at("skin_struts_outside").get<int>();
  out.pieces = sampling.at("pieces").get<int>();
  out.openings = parse_openings(sampling.at("openings"));
  for (const json& warning : sampling.at("warnings")) out.warnings.push_back(warning.get<std::string>());
  out.angles = measure_angles(frame);
  out.frame = std::move(frame);
  return out;
}

ReducedFrame parse_reduced(const json& reduced, const Frame& sampled) {
  ReducedFrame out;
  for (const json& node : reduced.at("nodes")) {
    if (node.size() != 3) refuse("reduced.nodes");
    out.frame.nodes_mm.emplace_back(node[0].get<double>(), node[1].get<double>(), node[2].get<double>());
    if (!out.frame.nodes_mm.back().allFinite()) refuse("reduced.nodes");
  }
  const std::size_t count = out.frame.nodes_mm.size(), skin_nodes = sampled.skin_node_count;
  if (count < skin_nodes || count > sampled.nodes_mm.size()) refuse("reduced.nodes");
  for (std::size_t i = 0; i < skin_nodes; ++i)
    if (out.frame.nodes_mm[i] != sampled.nodes_mm[i]) refuse(fmt::format("reduced.nodes[{}] is moved", i));
  out.frame.skin_node_count = sampled.skin_node_count;
  out.frame.skin_triangles = sampled.skin_triangles;
  for (const json& strut : reduced.at("struts")) {
    if (strut.size() != 3 || out.frame.struts.size() == sampled.struts.size()) refuse("reduced.struts");
    out.frame.struts.push_back({index_of(strut[0], count, "reduced.struts"),
                                index_of(strut[1], count, "reduced.struts"), strut[2].get<int>() != 0});
  }
  for (const json& radius : reduced.at("radii_mm")) out.radii_mm.push_back(radius.get<double>());
  if (out.radii_mm.size() != out.frame.struts.size()) refuse("reduced.radii_mm");
  for (const double radius : out.radii_mm)
    if (!(std::isfinite(radius) && radius >= 0)) refuse("reduced.radii_mm");
  out.volume_mm3 = positive(reduced, "volume_mm3");
  return out;
}

}  // namespace

std::string sampling_key(const Skin& skin, const FrameOptions& options, const RunContext& context) {
  std::string version = SKINFRAME_VERSION;
  auto [vertices, triangles] = std::pair(skin.inner_surface.vertices, skin.inner_surface.triangles);
  std::array values = {skin.thickness_mm,
                       skin.voxel_mm,
                       skin.plate_z_mm,
                       skin.cavity_volume_mm3,
                       skin.volume_mm3,
                       static_cast<double>(options.skin_nodes.value_or(-1)),
                       static_cast<double>(options.internal_nodes.value_or(-1)),
                       options.strut_radius_mm,
                       options.contact_tolerance_mm,
                       static_cast<double>(options.neighbours)};
  std::uint64_t seed = context.seed;
  ByteWriter bytes;
  bytes(version, vertices, triangles, values, seed);
  return fingerprint(bytes.take());
}

json initial_frame_json(const FrameProblem& posed, const SampledFrame& sampled, const std::string& density,
                        const std::string& key, const OptimizeResult* result) {
  json document = to_json(posed, {}, {});
  document["sampling"] = {{"key", key},
                          {"finger_edge_mm", sampled.finger_edge_mm},
                          {"contact_nodes", sampled.contact_nodes},
                          {"skin_nodes_requested", sampled.skin_nodes_requested},
                          {"mean_skin_edge_mm", sampled.mean_skin_edge_mm},
                          {"skin_nodes_sampled", sampled.skin_nodes_sampled},
                          {"density", density},
                          {"worst_outward_chord_mm", sampled.worst_outward_chord_mm},
                          {"worst_inward_chord_mm", sampled.worst_inward_chord_mm},
                          {"struts_left_out_crossing", sampled.struts_left_out_crossing},
                          {"skin_struts_outside", sampled.skin_struts_outside},
                          {"pieces", sampled.pieces},
                          {"openings", openings_json(sampled.openings)},
                          {"warnings", sampled.warnings}};
  document["reduced"] = result != nullptr ? reduced_json(*result) : json(nullptr);
  if (result != nullptr) add_bound_proofs(*result, posed, document);
  return document;
}

Result<InitialFrame> read_initial_frame(const std::filesystem::path& path) {
  const std::string name = "initial-frame.json of the earlier job";
  auto problem = read_problem(path, name);  // bounds the file's size and its tree
  if (!problem) return problem.error();
  try {
    std::ifstream in(path);
    const json document = json::parse(in);
    InitialFrame out;
    out.key = document.at("sampling").at("key").get<std::string>();
    out.problem = std::move(problem.value().problem);
    out.density = document.at("sampling").at("density").get<std::string>();
    out.sampled = parse_sampling(document.at("sampling"), out.problem.frame);
    if (!document.at("reduced").is_null())
      out.reduced = parse_reduced(document.at("reduced"), out.sampled.frame);
    return out;
  } catch (const std::exception& wrong) {  // json's and ours
    return invalid_input(fmt::format("{}: {}", name, wrong.what()));
  }
}

}  // namespace skinframe
