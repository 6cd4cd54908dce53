// SPDX-License-Identifier: Apache-2.0
#include "client/cli/load_option.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

namespace skinframe::client {
namespace {

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

std::optional<double> number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<v1::Vec3> xyz(std::string_view text) {
  const auto parts = split(text, ',');
  if (parts.size() != 3) return std::nullopt;
  std::array<double, 3> values{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto value = number(parts[i]);
    if (!value) return std::nullopt;
    values[i] = *value;
  }
  v1::Vec3 out;
  out.set_x(values[0]);
  out.set_y(values[1]);
  out.set_z(values[2]);
  return out;
}

std::optional<v1::Place> place(std::string_view text) {
  constexpr std::array<std::pair<std::string_view, v1::Place>, 6> kPlaces = {{{"top", v1::PLACE_TOP},
                                                                              {"bottom", v1::PLACE_BOTTOM},
                                                                              {"left", v1::PLACE_LEFT},
                                                                              {"right", v1::PLACE_RIGHT},
                                                                              {"front", v1::PLACE_FRONT},
                                                                              {"back", v1::PLACE_BACK}}};
  for (const auto& [name, value] : kPlaces) {
    if (name == text) return value;
  }
  return std::nullopt;
}

bool load_name(std::string_view name) {
  return !name.empty() && name.size() <= 32 && std::all_of(name.begin(), name.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
  });
}

}  // namespace

Result<v1::Load> parse_load(const std::string& text) {
  const auto wrong = [&](const std::string& what) {
    return Failure{FailureKind::kUsage,
                   fmt::format("--load {}: {}; the form is NAME:WHERE:FX,FY,FZ[:RADIUS], for example "
                               "side:top:20,0,0 or pinch:0,-30,80:0,10,0:4",
                               text, what)};
  };
  const auto parts = split(text, ':');
  if (parts.size() < 3 || parts.size() > 4) return wrong(fmt::format("has {} parts", parts.size()));
  v1::Load load;
  if (!load_name(parts[0])) return wrong("the name is not 1 to 32 of a-z, 0-9 and -");
  load.set_name(std::string(parts[0]));
  if (const auto named = place(parts[1])) {
    load.set_place(*named);
  } else if (const auto point = xyz(parts[1])) {
    *load.mutable_point_mm() = *point;
  } else {
    return wrong(
        fmt::format("\"{}\" is neither top, bottom, left, right, front, back nor x,y,z in mm", parts[1]));
  }
  const auto force = xyz(parts[2]);
  if (!force) return wrong(fmt::format("\"{}\" is no force FX,FY,FZ in N", parts[2]));
  if (force->x() == 0 && force->y() == 0 && force->z() == 0) return wrong("the force is zero");
  *load.mutable_force_n() = *force;
  if (parts.size() == 4) {
    const auto radius = number(parts[3]);
    if (!radius || *radius <= 0 || *radius > 1000) {
      return wrong(fmt::format("\"{}\" is no radius in mm, above 0 and at most 1000", parts[3]));
    }
    load.set_radius_mm(*radius);
  }
  return load;
}

Result<std::pair<std::string, std::string>> parse_label(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    return Failure{FailureKind::kUsage, fmt::format("--label {}: the form is KEY=VALUE", text)};
  }
  return std::pair(text.substr(0, equals), text.substr(equals + 1));
}

Result<google::protobuf::Duration> parse_deadline(const std::string& text) {
  constexpr double kLongest = 365 * 86400.0;
  std::string_view digits = text;
  double unit = 1;
  if (!digits.empty()) {
    const char last = digits.back();
    if (last == 's' || last == 'm' || last == 'h') digits.remove_suffix(1);
    unit = last == 'm' ? 60 : last == 'h' ? 3600 : 1;
  }
  const auto value = number(digits);
  if (!value || *value * unit < 1 || *value * unit > kLongest) {
    return Failure{
        FailureKind::kUsage,
        fmt::format("--deadline {}: the form is a time like 90s, 15m or 2h, 1 s to 365 days", text)};
  }
  google::protobuf::Duration out;
  const double seconds = *value * unit;
  out.set_seconds(static_cast<std::int64_t>(seconds));
  out.set_nanos(static_cast<std::int32_t>((seconds - std::floor(seconds)) * 1e9));
  return out;
}

}  // namespace skinframe::client
