// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/check/exported_frame.h"

#include <fmt/format.h>

#include <stdexcept>

#include "worker/check/json_fields.h"

namespace skinframe::check {

using nlohmann::json;

namespace {

// Throws std::out_of_range with the place of an index that names nothing.
int node_index(const json& value, std::size_t count, const std::string& place) {
  const auto index = value.get<long long>();
  if (index < 0 || static_cast<std::size_t>(index) >= count)
    throw std::out_of_range(fmt::format("{}: {} is not a node (0..{})", place, index, count - 1));
  return static_cast<int>(index);
}

}  // namespace

ExportedFrame parse_frame(const json& file, Radii radii) {
  ExportedFrame frame;
  const json& material = file.at("material");
  frame.tensile_modulus_mpa = material.at("tensile_modulus_mpa").get<double>();
  const auto mechanics = file.at("mechanics").get<std::string>();
  if (mechanics != "paper" && mechanics != "axial")
    throw std::out_of_range(fmt::format("mechanics \"{}\" is not known to this check", mechanics));
  frame.axial = mechanics == "axial";
  frame.shear_modulus_mpa = frame.axial ? 0.0 : material.at("shear_modulus_mpa").get<double>();
  frame.density_g_cm3 = material.at("density_g_cm3").get<double>();
  frame.tensile_strength_mpa = optional_number(material, "tensile_strength_mpa");
  frame.shear_strength_mpa = optional_number(material, "shear_strength_mpa");
  frame.slenderness = optional_number(material, "slenderness");
  frame.displacement_limit_mm = optional_number(file, "displacement_limit_mm");

  for (const json& node : file.at("nodes")) frame.nodes_mm.push_back(vector3(node));
  const std::size_t n = frame.nodes_mm.size();
  for (const json& item : file.at("struts")) {
    const std::string place = fmt::format("struts[{}]", frame.struts.size());
    ExportedStrut strut;
    strut.a = node_index(item.at("a"), n, place + ".a");
    strut.b = node_index(item.at("b"), n, place + ".b");
    strut.skin = item.at("skin").get<bool>();
    if (radii == Radii::kGiven) strut.radius_mm = item.at("radius_mm").get<double>();
    strut.min_radius_mm = item.at("min_radius_mm").get<double>();
    strut.max_radius_mm = item.at("max_radius_mm").get<double>();
    frame.struts.push_back(strut);
  }
  for (const json& item : file.value("skin_triangles", json::array())) {
    const std::string place = fmt::format("skin_triangles[{}]", frame.skin_triangles.size());
    frame.skin_triangles.push_back({node_index(item.at(0), n, place), node_index(item.at(1), n, place),
                                    node_index(item.at(2), n, place)});
  }
  frame.fixed.assign(n, {false, false, false});
  if (n == 0) return frame;
  for (const json& item : file.at("fixed")) {
    const int node = node_index(item.at("node"), n, "fixed.node");
    for (const char axis : item.at("axes").get<std::string>())
      if (axis >= 'x' && axis <= 'z') frame.fixed[node][axis - 'x'] = true;
  }
  frame.skin_weight_n.assign(n, 0.0);
  if (file.contains("skin_weight_n"))
    for (std::size_t i = 0; i < n; ++i) frame.skin_weight_n[i] = file.at("skin_weight_n").at(i).get<double>();
  if (file.contains("skin_mass")) {
    frame.skin_mass_weight_n = file.at("skin_mass").at("weight_n").get<double>();
    frame.skin_centroid_mm = vector3(file.at("skin_mass").at("centroid_mm"));
  }
  if (file.contains("balance_half_planes"))
    for (const json& plane : file.at("balance_half_planes"))
      frame.balance_half_planes.emplace_back(
          Eigen::Vector2d(plane.at("normal").at(0).get<double>(), plane.at("normal").at(1).get<double>()),
          plane.at("offset_mm").get<double>());
  for (const json& item : file.at("load_cases")) {
    ExportedLoadCase load_case;
    load_case.name = item.at("name").get<std::string>();
    load_case.gravity = item.at("gravity").get<bool>();
    load_case.force_n.assign(n, Eigen::Vector3d::Zero());
    for (const json& force : item.at("forces"))
      load_case.force_n[node_index(force.at("node"), n, "forces.node")] += vector3(force.at("force_n"));
    if (item.contains("displacements_mm"))
      for (const json& displacement : item.at("displacements_mm"))
        load_case.displacement_mm.push_back(vector3(displacement));
    frame.load_cases.push_back(std::move(load_case));
  }
  return frame;
}

std::optional<ExportedProof> parse_proof(const json& file, const char* key, const ExportedFrame& frame) {
  if (!file.contains(key) || file.at(key).is_null()) return std::nullopt;
  const json& item = file.at(key);
  ExportedProof proof;
  proof.volume_weight = item.at("volume_weight").get<double>();
  proof.feasibility_tolerance = item.at("feasibility_tolerance").get<double>();
  proof.value = item.at("value").get<double>();
  proof.removable_may_vanish = item.at("radii").get<std::string>() == "removable_may_vanish";
  proof.balance_multipliers = item.at("balance_multipliers").get<std::vector<double>>();
  const std::size_t planes = proof.balance_multipliers.size();
  if (planes != 0 && planes != frame.balance_half_planes.size())
    throw std::out_of_range(fmt::format("{}: {} balance multipliers for {} half planes", key, planes,
                                        frame.balance_half_planes.size()));
  for (const json& entry : item.at("fields")) {
    ExportedField field;
    const auto load_case = entry.at("load_case").get<long long>();
    if (load_case < 0 || static_cast<std::size_t>(load_case) >= frame.load_cases.size())
      throw std::out_of_range(fmt::format("{}: {} is not a load case", key, load_case));
    field.load_case = static_cast<int>(load_case);
    field.displacement_multiplier = entry.at("displacement_multiplier").get<double>();
    field.stress_multiplier = entry.at("stress_multiplier").get<double>();
    for (const json& d : entry.at("displacements_mm")) field.displacement_mm.push_back(vector3(d));
    if (field.displacement_mm.size() != frame.nodes_mm.size())
      throw std::out_of_range(fmt::format("{}: {} displacements for {} nodes", key,
                                          field.displacement_mm.size(), frame.nodes_mm.size()));
    proof.fields.push_back(std::move(field));
  }
  return proof;
}

}  // namespace skinframe::check
