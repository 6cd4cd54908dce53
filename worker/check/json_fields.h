// SPDX-License-Identifier: GPL-3.0-or-later
// Fields of exported JSON that several of its parsers read. They throw nlohmann's exceptions where a field is
// missing or of another type; read_exported names the file.
#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <optional>

namespace skinframe::check {

inline Eigen::Vector3d vector3(const nlohmann::json& value) {
  return {value.at(0).get<double>(), value.at(1).get<double>(), value.at(2).get<double>()};
}

// Nothing where the field is missing or null.
inline std::optional<double> optional_number(const nlohmann::json& object, const char* key) {
  const auto it = object.find(key);
  if (it == object.end() || it->is_null()) return std::nullopt;
  return it->get<double>();
}

}  // namespace skinframe::check
