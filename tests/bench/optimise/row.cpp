// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/bench/optimise/row.h"

namespace skinframe::bench {
namespace {

using nlohmann::json;

template <class T>
json value_or_null(const std::optional<T>& value) {
  return value ? json(*value) : json(nullptr);
}

template <class T>
void read(const json& from, const char* key, std::optional<T>& to) {
  if (from.contains(key) && !from[key].is_null()) to = from[key].get<T>();
}

}  // namespace

std::optional<double> Row::gap() const {
  const std::optional<double> sized = size_volume_mm3 ? size_volume_mm3 : volume_mm3;
  if (!lower_bound_mm3 || !sized || *lower_bound_mm3 <= 0) return std::nullopt;
  return *sized / *lower_bound_mm3 - 1;
}

json to_json(const Row& row) {
  json stages = json::array();
  for (const StageSize& s : row.stages)
    stages.push_back({{"nodes", s.nodes}, {"struts", s.struts}, {"volume_mm3", s.volume_mm3}});
  return {{"frame", row.frame},
          {"load", row.load},
          {"method", row.method},
          {"nodes", row.nodes},
          {"struts", row.struts},
          {"force_n", row.force_n},
          {"status", row.status},
          {"seconds", value_or_null(row.seconds)},
          {"cpu_seconds", value_or_null(row.cpu_seconds)},
          {"solve_seconds", value_or_null(row.solve_seconds)},
          {"iterations", value_or_null(row.iterations)},
          {"factorisations", value_or_null(row.factorisations)},
          {"volume_mm3", value_or_null(row.volume_mm3)},
          {"lower_bound_mm3", value_or_null(row.lower_bound_mm3)},
          {"size_volume_mm3", value_or_null(row.size_volume_mm3)},
          {"gap", value_or_null(row.gap())},
          {"relaxed_gap", value_or_null(row.relaxed_gap)},
          {"struts_left", value_or_null(row.struts_left)},
          {"worst_ratio", value_or_null(row.worst_ratio)},
          {"kkt_error", value_or_null(row.kkt_error)},
          {"peak_mb", value_or_null(row.peak_mb)},
          {"stages", stages}};
}

Row row_from_json(const json& from) {
  Row row;
  row.frame = from.value("frame", "");
  row.load = from.value("load", "");
  row.method = from.value("method", "");
  row.nodes = from.value("nodes", 0);
  row.struts = from.value("struts", 0);
  row.force_n = from.value("force_n", 0.0);
  row.status = from.value("status", "");
  read(from, "seconds", row.seconds);
  read(from, "cpu_seconds", row.cpu_seconds);
  read(from, "solve_seconds", row.solve_seconds);
  read(from, "iterations", row.iterations);
  read(from, "factorisations", row.factorisations);
  read(from, "volume_mm3", row.volume_mm3);
  read(from, "lower_bound_mm3", row.lower_bound_mm3);
  read(from, "relaxed_gap", row.relaxed_gap);
  read(from, "size_volume_mm3", row.size_volume_mm3);
  read(from, "struts_left", row.struts_left);
  read(from, "worst_ratio", row.worst_ratio);
  read(from, "kkt_error", row.kkt_error);
  read(from, "peak_mb", row.peak_mb);
  for (const json& s : from.value("stages", json::array()))
    row.stages.push_back({s.at("nodes"), s.at("struts"), s.at("volume_mm3")});
  return row;
}

}  // namespace skinframe::bench
