// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/check/exported_supports.h"

#include <fmt/format.h>

#include <limits>

namespace skinframe::check {
namespace {

int index_below(const nlohmann::json& value, long long least, std::size_t count, const char* what) {
  const auto index = value.get<long long>();
  if (index < least || index >= static_cast<long long>(count))
    throw std::out_of_range(fmt::format("supports: {} is not a {} ({}..{})", index, what, least, count - 1));
  return static_cast<int>(index);
}

}  // namespace

ExportedSupports parse_supports(const nlohmann::json& in_frame, const nlohmann::json& in_report,
                                std::size_t frame_nodes, std::size_t frame_struts) {
  ExportedSupports out;
  for (const auto& point : in_frame.at("printable_length"))
    out.printable_length.emplace_back(point.at("angle_deg").get<double>(),
                                      point.at("length_mm").is_null()
                                          ? std::numeric_limits<double>::infinity()
                                          : point.at("length_mm").get<double>());
  if (out.printable_length.empty()) throw std::out_of_range("supports.printable_length is empty");
  out.self_supporting_angle_deg = in_frame.at("self_supporting_angle_deg").get<double>();
  out.plate_z_mm = in_frame.at("plate_z_mm").get<double>();
  out.plate_reach_mm = in_frame.at("plate_reach_mm").get<double>();
  out.skin_tie_radius_mm = in_frame.at("skin_tie_radius_mm").get<double>();
  for (const auto& item : in_frame.at("nodes")) {
    const auto& at = item.at("at_mm");
    out.nodes.push_back({{at.at(0).get<double>(), at.at(1).get<double>(), at.at(2).get<double>()},
                         item.at("on").get<std::string>(),
                         index_below(item.at("strut"), -1, frame_struts, "strut")});
    if ((out.nodes.back().on == "strut") != (out.nodes.back().strut >= 0))
      throw std::out_of_range(fmt::format("supports.nodes[{}].strut", out.nodes.size() - 1));
  }
  const std::size_t count = frame_nodes + out.nodes.size();
  for (const auto& item : in_frame.at("struts"))
    out.struts.push_back({index_below(item.at("a"), 0, count, "node"),
                          index_below(item.at("b"), 0, count, "node"), item.at("radius_mm").get<double>(),
                          item.at("support").get<std::string>() == "external"});
  out.count = in_report.at("count").get<int>();
  out.internal = in_report.at("internal").get<int>();
  out.external = in_report.at("external").get<int>();
  out.length_mm = in_report.at("length_mm").get<double>();
  out.volume_mm3 = in_report.at("volume_mm3").get<double>();
  out.internal_volume_mm3 = in_report.at("internal_volume_mm3").get<double>();
  out.external_volume_mm3 = in_report.at("external_volume_mm3").get<double>();
  out.weight_g = in_report.at("weight_g").get<double>();
  const auto& overhang = in_report.at("overhang");
  out.roof_beyond_mm2 = overhang.at("roof_beyond_mm2").get<double>();
  out.underside_beyond_mm2 = overhang.at("underside_beyond_mm2").get<double>();
  out.cavity_surface_mm2 = overhang.at("cavity_surface_mm2").get<double>();
  out.beyond_share = overhang.at("beyond_share").get<double>();
  const auto& print = in_report.at("print_state");
  out.worst_vertical_deformation_mm = print.at("worst_vertical_deformation_mm").get<double>();
  if (print.contains("limit_mm")) out.deformation_limit_mm = print.at("limit_mm").get<double>();
  return out;
}

}  // namespace skinframe::check
