// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/check/exported_verification.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

#include "worker/check/json_fields.h"

namespace skinframe::check {
namespace {

using nlohmann::json;

constexpr std::uintmax_t kMaxBytes = std::uintmax_t{1} << 28;
constexpr std::size_t kMostPinchSites = 1000;
constexpr std::size_t kPlacedBytes = 15, kFigureBytes = 4, kTriangleBytes = 13;

double float_at(const std::string& bytes, std::size_t at) {
  float v = 0;
  std::memcpy(&v, bytes.data() + at, sizeof v);
  return v;
}

// A skin with floats at its vertices, by their names.
struct ColouredSkin {
  std::vector<Eigen::Vector3d> at_mm;
  std::vector<std::vector<double>> figures;
};

Result<ColouredSkin> read_skin(const std::filesystem::path& path, const std::vector<std::string>& names) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) return io_error(fmt::format("{}: {}", path.string(), error.message()));
  if (size > kMaxBytes) return invalid_input(fmt::format("{}: {} bytes are too many", path.string(), size));
  std::ifstream in(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(in)), {});
  const std::string end = "end_header\n";
  const std::size_t header = bytes.find(end);
  if (!bytes.starts_with("ply\nformat binary_little_endian 1.0\n") || header == std::string::npos)
    return invalid_input(fmt::format("{}: no binary PLY", path.string()));
  std::size_t vertices = 0, triangles = 0;
  std::string properties, word, wanted = "x y z red green blue ";
  for (const std::string& name : names) wanted += name + " ";
  std::istringstream lines(bytes.substr(0, header));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    words >> word;
    if (word == "element") {
      words >> word;
      words >> (word == "vertex" ? vertices : triangles);
    } else if (word == "property" && triangles == 0) {
      words >> word >> word;
      properties += word + " ";
    }
  }
  const std::size_t at = header + end.size(), vertex_bytes = kPlacedBytes + kFigureBytes * names.size();
  if (properties != wanted || vertices > bytes.size() || triangles > bytes.size() ||
      bytes.size() != at + vertices * vertex_bytes + triangles * kTriangleBytes)
    return invalid_input(fmt::format("{}: its header and its size do not agree", path.string()));
  ColouredSkin out;
  for (std::size_t i = 0; i < vertices; ++i) {
    const std::size_t from = at + i * vertex_bytes;
    out.at_mm.emplace_back(float_at(bytes, from), float_at(bytes, from + 4), float_at(bytes, from + 8));
    out.figures.emplace_back();
    for (std::size_t k = 0; k < names.size(); ++k)
      out.figures.back().push_back(float_at(bytes, from + kPlacedBytes + kFigureBytes * k));
  }
  return out;
}

// The largest of a figure over a design's loads, or the least; none where no load has it.
std::optional<double> extreme(const json& design, const char* figure, bool largest) {
  std::optional<double> out;
  if (design.is_null()) return out;
  for (const json& load : design.at("loads"))
    if (const auto x = optional_number(load, figure))
      out = !out ? *x : largest ? std::max(*out, *x) : std::min(*out, *x);
  return out;
}

std::vector<ExportedRow> rows_of_designs(const json& designs) {
  const json &ours = designs.at("skin_frame"), &hollow = designs.at("hollow");
  const auto own = [](const json& design, const char* figure) {
    return design.is_null() ? std::nullopt : optional_number(design, figure);
  };
  return {{"max_displacement_mm", "", extreme(ours, "max_displacement_mm", true),
           extreme(hollow, "max_displacement_mm", true)},
          {"pinch_mean_mm", "", own(ours, "pinch_mean_mm"), own(hollow, "pinch_mean_mm")},
          {"pinch_max_mm", "", own(ours, "pinch_max_mm"), own(hollow, "pinch_max_mm")},
          {"buckling_factor", "", extreme(ours, "buckling_factor", false),
           extreme(hollow, "buckling_factor", false)}};
}

}  // namespace

ExportedVerification parse_verification(const json& item) {
  ExportedVerification out;
  out.verified = item.at("label").get<std::string>() == "verified";
  if (!out.verified) {
    out.figures_without = item.size() != 2 || !item.contains("reason");
    return out;
  }
  out.max_displacement_mm = item.at("max_displacement_mm").get<double>();
  out.max_stress_mpa = item.at("max_stress_mpa").get<double>();
  out.balance_force = item.at("balance").at("force").get<double>();
  out.balance_moment = item.at("balance").at("moment").get<double>();
  out.strength_mpa = optional_number(item, "strength_mpa");
  out.safety_factor = optional_number(item, "safety_factor");
  out.buckling_factor = optional_number(item, "buckling_factor");
  out.pinch_mean_mm = optional_number(item, "pinch_mean_mm");
  out.pinch_max_mm = optional_number(item, "pinch_max_mm");
  out.hollow_thickness_mm = optional_number(item, "hollow_thickness_mm");
  out.hollow_max_displacement_mm = optional_number(item, "hollow_max_displacement_mm");
  if (item.contains("pinch") && item.at("pinch").at("sites").size() > kMostPinchSites)
    throw std::out_of_range("verification.pinch.sites: too many");
  if (item.contains("pinch"))
    for (const json& site : item.at("pinch").at("sites"))
      out.pinch_sites.push_back({{vector3(site.at("fingers_mm").at(0)), vector3(site.at("fingers_mm").at(1))},
                                 site.at("closing_mm").get<double>()});
  for (const json& load : item.at("loads"))
    out.loads.push_back({load.at("name").get<std::string>(), load.at("max_displacement_mm").get<double>(),
                         load.at("max_skin_stress_mpa").get<double>(),
                         load.at("max_strut_stress_mpa").get<double>(),
                         optional_number(load, "buckling_factor")});
  for (const json& row : item.at("comparison").at("rows"))
    out.rows.push_back({row.at("figure").get<std::string>(), row.at("better").get<std::string>(),
                        optional_number(row, "skin_frame"), optional_number(row, "hollow")});
  out.of_designs = rows_of_designs(item.at("comparison").at("designs"));
  out.verdict = item.at("comparison").at("verdict").get<std::string>();
  return out;
}

Result<ExportedDeformation> read_deformation(const std::filesystem::path& path) {
  auto skin = read_skin(path, {"displacement_x", "displacement_y", "displacement_z"});
  if (!skin) return skin.error();
  ExportedDeformation out;
  const std::string stem = path.stem().string();
  out.load = stem.substr(stem.find('-') + 1);
  out.at_mm = std::move(skin->at_mm);
  for (const auto& d : skin->figures) out.displacement_mm.emplace_back(d[0], d[1], d[2]);
  return out;
}

Result<ExportedPinch> read_pinch(const std::filesystem::path& path) {
  auto skin = read_skin(path, {"closing"});
  if (!skin) return skin.error();
  ExportedPinch out;
  out.at_mm = std::move(skin->at_mm);
  for (const auto& figure : skin->figures) out.closing_mm.push_back(figure[0]);
  return out;
}

}  // namespace skinframe::check
