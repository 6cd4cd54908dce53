// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/problem/strut_sizes.h"

#include <fmt/format.h>

#include <cstdlib>

namespace skinframe {
namespace {

using nlohmann::json;

json short_numbers(const std::vector<double>& values) {
  json out = json::array();
  for (const double value : values) out.push_back(std::strtod(fmt::format("{:.9g}", value).c_str(), nullptr));
  return out;
}

json sizes_json(const StageRecord& stage) {
  return {{"radii_mm", short_numbers(stage.radii_mm)}, {"lengths_mm", short_numbers(stage.lengths_mm)}};
}

}  // namespace

json strut_sizes_json(const OptimizeResult& result) {
  return {{"initial", sizes_json(result.initial)},
          {"size", sizes_json(result.size)},
          {"topology", sizes_json(result.topology)}};
}

}  // namespace skinframe
