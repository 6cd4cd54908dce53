// SPDX-License-Identifier: Apache-2.0
// A frame problem file as the oracle reads it: by code of its own, from the format's description alone.
// Trusts its input as far as a test may: what is missing throws nlohmann::json::exception.
//
// Units: mm, N, MPa; density in g/cm3. A null or absent strength, slenderness or limit is off.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace oracle {

struct FrameStrut {
  int a = 0, b = 0;
  Eigen::Vector3d direction;  // of unit length, a to b
  double length = 0;
  double least_area = 0, most_area = 0;  // from radii and slenderness
};

struct FrameCase {
  bool gravity = true;
  std::vector<Eigen::Vector3d> force;  // external, and the skin's weight where gravity acts; one a node
};

struct BaseEdge {
  Eigen::Vector2d normal;
  double offset = 0;
};

struct FrameFile {
  std::vector<Eigen::Vector3d> nodes;
  std::vector<FrameStrut> struts;
  std::vector<std::array<bool, 3>> fixed;
  std::vector<FrameCase> cases;
  double tension = 0, shear = 0;  // moduli; the shear modulus is 0 for axial mechanics
  std::optional<double> tensile_strength, shear_strength, displacement_limit;
  double weight = 0;  // of a mm3, in N
  std::vector<BaseEdge> base;
  double skin_weight = 0;
  Eigen::Vector3d skin_centroid = Eigen::Vector3d::Zero();
};

FrameFile read_frame_file(const std::string& path);

}  // namespace oracle
