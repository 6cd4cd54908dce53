// SPDX-License-Identifier: Apache-2.0
// JSON whose fields know their lines, so that a message can say where a person has to look.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "absl/status/statusor.h"

namespace skinframe::server {

struct LinedJson {
  nlohmann::json value;
  // By path, "printer.sources.min_radius_mm" or "printer.printable_length.points[2]"; 1 is the first line.
  std::map<std::string, int> lines;

  int line(const std::string& path) const;  // of the nearest known part of the path
};

// INVALID_ARGUMENT "FILE:LINE: what is wrong": not JSON, not UTF-8, a field that stands twice, deeper
// than 16.
absl::StatusOr<LinedJson> parse_lined_json(std::string_view text, const std::string& file);

}  // namespace skinframe::server
