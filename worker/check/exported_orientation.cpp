// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/check/exported_orientation.h"

namespace skinframe::check {
namespace {

ExportedAttitude parse_attitude(const nlohmann::json& item) {
  ExportedAttitude attitude;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      attitude.rotation(row, column) = item.at("rotation").at(row).at(column).get<double>();
  attitude.support_estimate_mm3 = item.at("support_estimate_mm3").get<double>();
  attitude.standing_margin_mm = item.at("standing_margin_mm").get<double>();
  return attitude;
}

}  // namespace

std::optional<ExportedOrientation> parse_orientation(const nlohmann::json& mesh) {
  if (!mesh.contains("orientation") || mesh.at("orientation").at("chosen").is_null()) return std::nullopt;
  const nlohmann::json& item = mesh.at("orientation");
  ExportedOrientation orientation;
  orientation.printer = item.at("printer").get<std::string>();
  orientation.chosen = parse_attitude(item.at("chosen"));
  if (!item.at("runner_up").is_null()) orientation.runner_up = parse_attitude(item.at("runner_up"));
  return orientation;
}

}  // namespace skinframe::check
