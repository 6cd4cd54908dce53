// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/check/exported_drain.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "worker/check/json_fields.h"

namespace skinframe::check {
namespace {

constexpr double kOnWallMm = 2e-3;

}  // namespace

BesideHole nearest_hole(const std::vector<ExportedHole>& holes, const Eigen::Vector3d& p) {
  BesideHole best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < holes.size(); ++k) {
    const ExportedHole& hole = holes[k];
    const Eigen::Vector3d from = p - hole.centre_mm;
    if (from.norm() >= least) continue;
    least = from.norm();
    const double along = from.dot(hole.axis);
    best = {static_cast<int>(k), (from - along * hole.axis).norm(), along};
  }
  return best;
}

bool in_a_hole(const ExportedDrain& drain, const Eigen::Vector3d& p) {
  const BesideHole near = nearest_hole(drain.holes, p);
  if (near.hole < 0) return false;
  const ExportedHole& hole = drain.holes[near.hole];
  return near.beside_mm <= 0.5 * hole.diameter_mm + kOnWallMm && near.along_mm <= hole.rise_mm &&
         near.along_mm >= -hole.clear_mm;
}

namespace {

std::vector<ExportedHole> parse_holes(const nlohmann::json& items) {
  std::vector<ExportedHole> holes;
  for (const auto& entry : items) {
    ExportedHole hole;
    hole.centre_mm = vector3(entry.at("centre_mm"));
    hole.axis = vector3(entry.at("axis"));
    hole.diameter_mm = entry.at("diameter_mm").get<double>();
    hole.rise_mm = entry.at("rise_mm").get<double>();
    hole.clear_mm = entry.at("clear_mm").get<double>();
    if (std::abs(hole.axis.norm() - 1.0) > 1e-6 || !(hole.diameter_mm > 0.0))
      throw std::out_of_range("drain_holes: a hole without axis or diameter");
    holes.push_back(hole);
  }
  return holes;
}

}  // namespace

ExportedDrain parse_drain(const nlohmann::json& item) {
  ExportedDrain drain;
  drain.rule_diameter_mm = item.at("rule").at("diameter_mm").get<double>();
  drain.rule_least_count = item.at("rule").at("least_count").get<int>();
  drain.outer_triangles = item.at("outer_triangles").get<std::size_t>();
  drain.caps = item.at("caps").at("count").get<int>();
  drain.cap_clearance_mm = item.at("caps").at("clearance_mm").get<double>();
  drain.cap_thickness_mm = item.at("caps").at("thickness_mm").get<double>();
  drain.holes = parse_holes(item.at("holes"));
  drain.uncut = parse_holes(item.at("uncut"));
  for (const auto& entry : item.at("sealed_voids"))
    drain.sealed.push_back({entry.at("volume_mm3").get<double>(), vector3(entry.at("centre_mm"))});
  return drain;
}

}  // namespace skinframe::check
