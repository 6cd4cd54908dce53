// SPDX-License-Identifier: Apache-2.0
#include "tests/oracle/frame_file.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <stdexcept>

namespace oracle {
namespace {

using Eigen::Vector3d;
using nlohmann::json;

constexpr double kGravity = 9810;       // mm/s2
constexpr double kTonnePerGram = 1e-9;  // g/cm3 to t/mm3
constexpr double kSlenderRoom = 1.01;   // above the slender radius, of a strut too long for its upper bound

std::optional<double> limit(const json& object, const char* key) {
  if (!object.contains(key) || object[key].is_null()) return std::nullopt;
  return object[key].get<double>();
}

Vector3d vector3(const json& list) {
  return {list.at(0).get<double>(), list.at(1).get<double>(), list.at(2).get<double>()};
}

void read_struts(const json& document, FrameFile& frame) {
  const auto slenderness = limit(document.at("material"), "slenderness");
  for (const json& entry : document.at("struts")) {
    FrameStrut strut;
    strut.a = entry.at("a");
    strut.b = entry.at("b");
    const Vector3d along = frame.nodes.at(strut.b) - frame.nodes.at(strut.a);
    strut.length = along.norm();
    strut.direction = along / strut.length;
    const double slender = slenderness ? strut.length / *slenderness : 0;
    double least = entry.at("min_radius_mm"), most = entry.at("max_radius_mm");
    if (slender > most) most = kSlenderRoom * slender;
    least = std::max(least, slender);
    strut.least_area = std::numbers::pi * least * least;
    strut.most_area = std::numbers::pi * most * most;
    frame.struts.push_back(strut);
  }
}

void read_cases(const json& document, FrameFile& frame) {
  for (const json& entry : document.at("load_cases")) {
    FrameCase load;
    load.gravity = entry.value("gravity", true);
    load.force.assign(frame.nodes.size(), Vector3d::Zero());
    if (entry.contains("forces"))
      for (const json& force : entry["forces"])
        load.force.at(force.at("node").get<std::size_t>()) += vector3(force.at("force_n"));
    if (load.gravity && document.contains("skin_weight_n"))
      for (std::size_t i = 0; i < document["skin_weight_n"].size(); ++i)
        load.force.at(i).z() -= document["skin_weight_n"][i].get<double>();
    frame.cases.push_back(std::move(load));
  }
}

void read_balance(const json& document, FrameFile& frame) {
  if (document.contains("skin_mass")) {
    frame.skin_weight = document["skin_mass"].at("weight_n");
    frame.skin_centroid = vector3(document["skin_mass"].at("centroid_mm"));
  }
  if (!document.contains("balance_half_planes")) return;
  for (const json& entry : document["balance_half_planes"])
    frame.base.push_back({{entry.at("normal").at(0).get<double>(), entry.at("normal").at(1).get<double>()},
                          entry.at("offset_mm").get<double>()});
}

}  // namespace

FrameFile read_frame_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw std::runtime_error(path + ": cannot be read");
  const json document = json::parse(in);
  FrameFile frame;
  const json& material = document.at("material");
  const std::string mechanics = document.at("mechanics");
  if (mechanics != "paper" && mechanics != "axial") throw std::runtime_error("mechanics: " + mechanics);
  frame.tension = material.at("tensile_modulus_mpa");
  if (mechanics == "paper") {
    frame.shear = material.at("shear_modulus_mpa");
    frame.shear_strength = limit(material, "shear_strength_mpa");
  }
  frame.tensile_strength = limit(material, "tensile_strength_mpa");
  frame.weight = material.at("density_g_cm3").get<double>() * kTonnePerGram * kGravity;
  frame.displacement_limit = limit(document, "displacement_limit_mm");
  for (const json& node : document.at("nodes")) frame.nodes.push_back(vector3(node));
  frame.fixed.assign(frame.nodes.size(), {false, false, false});
  for (const json& entry : document.at("fixed"))
    for (const char axis : entry.at("axes").get<std::string>())
      frame.fixed.at(entry.at("node").get<std::size_t>()).at(static_cast<std::size_t>(axis - 'x')) = true;
  read_struts(document, frame);
  read_cases(document, frame);
  read_balance(document, frame);
  return frame;
}

}  // namespace oracle
