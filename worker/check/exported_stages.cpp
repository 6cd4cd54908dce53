// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/check/exported_stages.h"

namespace skinframe::check {

std::vector<ExportedStage> parse_stages(const nlohmann::json& frame, const nlohmann::json& counts) {
  std::vector<ExportedStage> stages;
  if (!frame.contains("strut_sizes")) return stages;
  for (const char* name : {"initial", "size", "topology"}) {
    const nlohmann::json& item = frame.at("strut_sizes").at(name);
    stages.push_back({name, item.at("radii_mm").get<std::vector<double>>(),
                      item.at("lengths_mm").get<std::vector<double>>(),
                      counts.at(name).at("struts").get<int>(), std::nullopt});
  }
  return stages;
}

void report_volumes(ExportedPrinter* out, std::optional<double> initial_mm3) {
  if (out->stages.empty()) return;
  out->stages[0].volume_mm3 = initial_mm3;
  out->stages[1].volume_mm3 = out->size_volume_mm3;
  out->stages[2].volume_mm3 = out->topology_volume_mm3;
}

}  // namespace skinframe::check
