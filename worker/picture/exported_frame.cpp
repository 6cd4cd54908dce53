// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/picture/exported_frame.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "worker/profile/import_profile.h"

namespace skinframe::picture {
namespace {

using nlohmann::json;

constexpr std::size_t kMostBytes = std::size_t{1} << 30;

Eigen::Vector3d point(const json& value, const std::string& place) {
  const Eigen::Vector3d p(value.at(0).get<double>(), value.at(1).get<double>(), value.at(2).get<double>());
  if (!(p.cwiseAbs().maxCoeff() <= kFurthestMm))
    throw std::out_of_range(fmt::format("{}: further out than {:g} mm", place, kFurthestMm));
  return p;
}

void require_few(const json& list, const char* name) {
  if (!list.is_array()) throw std::out_of_range(fmt::format("{}: is no list", name));
  if (list.size() > kMostStruts)
    throw std::out_of_range(fmt::format("{}: {} are more than {}", name, list.size(), kMostStruts));
}

std::vector<DrawnStrut> read_struts(const json& list, const std::vector<Eigen::Vector3d>& nodes_mm,
                                    const std::string& name) {
  require_few(list, name.c_str());
  std::vector<DrawnStrut> struts;
  for (const json& item : list) {
    const std::string place = fmt::format("{}[{}]", name, struts.size());
    const auto node = [&](const char* end) {
      const auto index = item.at(end).get<long long>();
      if (index < 0 || static_cast<std::size_t>(index) >= nodes_mm.size())
        throw std::out_of_range(fmt::format("{}.{}: {} is not a node", place, end, index));
      return nodes_mm[static_cast<std::size_t>(index)];
    };
    const auto radius_mm = item.at("radius_mm").get<double>();
    if (!(radius_mm >= 0 && radius_mm <= kFurthestMm))
      throw std::out_of_range(fmt::format("{}.radius_mm: {} is no radius", place, radius_mm));
    struts.push_back({node("a"), node("b"), radius_mm});
  }
  return struts;
}

StageSizes read_stage(const json& sizes, const char* key, const char* name) {
  StageSizes stage{name, {}, {}};
  for (const auto& [field, values] :
       {std::pair("radii_mm", &stage.radii_mm), {"lengths_mm", &stage.lengths_mm}}) {
    const json& list = sizes.at(key).at(field);
    require_few(list, key);
    *values = list.get<std::vector<double>>();
    for (const double value : *values)
      if (!(value >= 0 && value <= 4 * kFurthestMm))
        throw std::out_of_range(fmt::format("strut_sizes.{}.{}: {} is no size", key, field, value));
  }
  return stage;
}

DrawnFrame parse(const json& file) {
  DrawnFrame frame;
  const json& nodes = file.at("nodes");
  require_few(nodes, "nodes");
  std::vector<Eigen::Vector3d> nodes_mm;
  for (const json& node : nodes) nodes_mm.push_back(point(node, fmt::format("nodes[{}]", nodes_mm.size())));
  frame.struts = read_struts(file.at("struts"), nodes_mm, "struts");
  if (frame.struts.empty()) throw std::out_of_range("struts: there are none");
  if (file.contains("supports")) {
    const json& supports = file.at("supports");
    require_few(supports.at("nodes"), "supports.nodes");
    for (const json& node : supports.at("nodes"))
      nodes_mm.push_back(point(node.at("at_mm"), "supports.nodes"));
    frame.supports = read_struts(supports.at("struts"), nodes_mm, "supports.struts");
  }
  if (file.contains("strut_sizes")) {
    const json& sizes = file.at("strut_sizes");
    frame.stages = {read_stage(sizes, "initial", "initial"), read_stage(sizes, "size", "after sizing"),
                    read_stage(sizes, "topology", "after topology")};
  }
  StageSizes last{frame.stages.empty() ? "exported" : "after geometry", {}, {}};
  for (const DrawnStrut& strut : frame.struts) {
    last.radii_mm.push_back(strut.radius_mm);
    last.lengths_mm.push_back((strut.b_mm - strut.a_mm).norm());
  }
  frame.stages.push_back(std::move(last));
  return frame;
}

}  // namespace

Result<DrawnFrame> read_frame(const std::filesystem::path& path) {
  const auto file = read_json_file(path, kMostBytes);
  if (!file) return file.error();
  try {
    return parse(*file);
  } catch (const std::exception& error) {  // what is missing or of another kind, by nlohmann; or ours
    return invalid_input(fmt::format("{}: {}", path.string(), error.what()));
  }
}

}  // namespace skinframe::picture
