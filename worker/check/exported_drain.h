// SPDX-License-Identifier: GPL-3.0-or-later
// Drain holes as report.json tells of them, and the meshes beside skin-frame.stl.
#pragma once

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "worker/mesh/triangle_mesh.h"

namespace skinframe::check {

struct ExportedHole {
  Eigen::Vector3d centre_mm = Eigen::Vector3d::Zero(), axis = Eigen::Vector3d::UnitZ();
  double diameter_mm = 0, rise_mm = 0, clear_mm = 0;
};
struct ExportedVoid {
  double volume_mm3 = 0;
  Eigen::Vector3d centre_mm = Eigen::Vector3d::Zero();
};
struct ExportedDrain {
  double rule_diameter_mm = 0;
  int rule_least_count = 0;
  std::vector<ExportedHole> holes;
  std::vector<ExportedHole> uncut;  // the frame has their rims, the skin is closed there
  std::vector<ExportedVoid> sealed;
  std::size_t outer_triangles = 0;
  int caps = 0;
  double cap_clearance_mm = 0, cap_thickness_mm = 0;
  TriangleMesh lids_mesh, caps_mesh;  // vertices welded; empty where there is no such file
};

// How far beside the axis of the nearest hole the point stands, and along it from the hole's centre; `hole`
// is -1 where there are none.
struct BesideHole {
  int hole = -1;
  double beside_mm = 0, along_mm = 0;
};
BesideHole nearest_hole(const std::vector<ExportedHole>& holes, const Eigen::Vector3d& point_mm);

// Within a hole's cylinder, its wall included.
bool in_a_hole(const ExportedDrain& drain, const Eigen::Vector3d& point_mm);

// Throws json's exceptions and std::out_of_range.
ExportedDrain parse_drain(const nlohmann::json& in_report);

}  // namespace skinframe::check
