// SPDX-License-Identifier: GPL-3.0-or-later
// Constraints (1)-(10) of a frame with given radii, evaluated from scratch: what the optimiser claims is
// measured here.
#pragma once

#include <string>
#include <vector>

#include "worker/mechanics/equilibrium.h"
#include "worker/mechanics/frame_problem.h"

namespace skinframe {

// A strut thinner than this counts as absent: no stress, no slenderness (zeta, the paper's removal
// threshold).
inline constexpr double kVanishedRadiusMm = 1e-5;

// Ratios are demand over limit: <= 1 holds. A limit that is not asked for leaves its ratio at 0.
struct Evaluation {
  double max_displacement_mm = 0;  // over nodes and load cases (6)
  int worst_node = -1;             // where; -1 without load cases
  int worst_load_case = -1;
  double displacement_ratio = 0;  // max_displacement_mm / limit
  double max_axial_ratio = 0;     // (2)
  double max_shear_ratio = 0;     // (3)
  int worst_axial_strut = -1;
  int worst_shear_strut = -1;
  double max_slenderness_ratio = 0;  // (4,5): l / (alpha r)
  double radius_violation_mm =
      0;  // (9,10): how far the worst radius stands outside its bounds, widened as in area_bounds
  double min_radius_mm = 0;  // thinnest strut that is there; 0 when none is
  int widened_struts = 0;    // where slenderness exceeds the upper bound
  // (8): signed distance of the centre of gravity of skin and frame to the nearest edge of the hull, > 0
  // inside; infinite when no balance is asked for.
  double balance_margin_mm = 0;
  Eigen::Vector3d centre_of_gravity_mm = Eigen::Vector3d::Zero();
  double frame_volume_mm3 = 0;      // (12)
  double equilibrium_residual = 0;  // (1): worst over load cases, relative
  bool in_equilibrium = true;
};

Evaluation evaluate(const FrameProblem& problem, const std::vector<double>& radii_mm);

// The same from responses already at hand, one a load case in the problem's order.
Evaluation evaluate(const FrameProblem& problem, const std::vector<double>& radii_mm,
                    const std::vector<CaseResponse>& responses);

// Name of the constraint that is violated most, beyond `tolerance` (relative; for balance in mm):
// "displacement", "axial stress", "shear stress", "slenderness", "radius", "balance", "equilibrium"; empty
// when all hold.
std::string violated_constraint(const Evaluation& evaluation, double tolerance);

// The largest of displacement, axial and shear ratio; infinite when not in equilibrium. <= 1: (2), (3), (6)
// hold.
double utilisation(const Evaluation& evaluation);

}  // namespace skinframe
