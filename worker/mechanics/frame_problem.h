// SPDX-License-Identifier: GPL-3.0-or-later
// What the optimiser is asked: a frame, its material, its supports and loads, and the limits it has to keep.
// Equation numbers are those of Wang et al. 2013. Units: mm, N, MPa, tonne; density enters in g/cm3.
//
// Invariants, checked by validate():
//  1. The frame is well formed: indices in range, no strut of zero length, no two struts between the same
//  nodes.
//  2. bounds has one entry a strut, fixed and free_nodes one a node, force_n of each load case one a node;
//     skin_weight_n one a node or none at all. free_nodes may be empty: then no node moves.
//  3. Every number is finite; moduli are positive; 0 <= min_mm <= max_mm and 0 < max_mm; limits are positive.
//  4. A node that moves in geometry optimisation is neither fixed, nor loaded, nor of the skin.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "worker/frame/frame.h"
#include "worker/run/result.h"

namespace skinframe {

// How a strut resists its ends' relative displacement. See strut_element.h.
enum class ElementModel {
  kPaper,  // axial and shear springs, no rotations: the paper's, (1)-(3)
  kAxial,  // the pin-jointed bar of the textbooks: no shear spring
};

const char* to_string(ElementModel model);  // "paper", "axial": the names of the problem file

inline constexpr double kGravityMmPerS2 = 9810.0;

struct Material {
  std::string id;
  double tensile_modulus_mpa = 0;              // gamma in Table 1
  double shear_modulus_mpa = 0;                // mu; not read by the axial element
  std::optional<double> tensile_strength_mpa;  // sigma of (2); none: no limit
  std::optional<double> shear_strength_mpa;    // tau of (3); none: no limit
  std::optional<double> slenderness;           // alpha of (4,5); none: no limit
  double density_g_cm3 = 0;

  // rho g: 1 g/cm3 = 1e-9 t/mm3.
  double weight_density_n_mm3() const { return density_g_cm3 * 1e-9 * kGravityMmPerS2; }
};

struct RadiusBounds {
  double min_mm = 0;  // 0 lets the strut vanish
  double max_mm = 0;
};

struct LoadCase {
  std::string name;
  bool gravity = true;                   // self weight of struts and skin acts along -z
  std::vector<Eigen::Vector3d> force_n;  // external, one a node
};

// normal . (x, y) <= offset_mm, normal of unit length: one edge of the hull of the base contact, for (8).
struct HalfPlane {
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();
  double offset_mm = 0;
};

// The skin as a whole, for balance (8).
struct FixedMass {
  double weight_n = 0;
  Eigen::Vector3d centroid_mm = Eigen::Vector3d::Zero();
};

struct FrameProblem {
  ElementModel element = ElementModel::kPaper;
  Material material;
  Frame frame;
  std::vector<RadiusBounds> bounds;        // (9), (10), one a strut
  std::vector<std::array<bool, 3>> fixed;  // axes held at zero, one a node
  std::vector<double> skin_weight_n;       // lumped to the nodes, one a node or empty
  std::vector<LoadCase> load_cases;
  std::optional<double> displacement_limit_mm;  // epsilon of (6)
  std::vector<HalfPlane> balance;               // (8); empty: not asked for
  FixedMass skin_mass;
  std::vector<bool> free_nodes;  // may move in geometry optimisation, one a node or empty
};

// Ok, or the first invariant that does not hold, naming the element.
Status validate(const FrameProblem& problem);

// The bounds on the area of one strut in mm2 that (4), (5), (9) and (10) leave at its present length.
// A strut too long for its upper bound, l / alpha > max, gets the slender radius and kSlenderRoom above it:
// slenderness wins over the upper bound, because a strut that buckles is worse than one that shows.
struct AreaBounds {
  double lower_mm2 = 0;
  double upper_mm2 = 0;
  bool widened = false;  // slenderness exceeded the upper bound
};
inline constexpr double kSlenderRoom = 1.01;  // relative, on the radius
AreaBounds area_bounds(const FrameProblem& problem, int strut);

// Which nodes touch a skin strut; which carry an external force in some load case.
std::vector<bool> skin_nodes(const Frame& frame);
std::vector<bool> loaded_nodes(const FrameProblem& problem);

// sum A_j l_j of (12), from radii.
double frame_volume_mm3(const Frame& frame, const std::vector<double>& radii_mm);

}  // namespace skinframe
