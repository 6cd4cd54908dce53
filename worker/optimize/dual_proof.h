// SPDX-License-Identifier: GPL-3.0-or-later
// What holds for every choice of areas, and the few numbers that prove it.
//
// Let A be areas within bounds that keep the limits, and D the displacements of one load case: K(A) D = F(A).
// For any field y of virtual displacements (D - y)^T K (D - y) >= 0, hence
//
//   2 F(A)^T y - y^T K(A) y  <=  F(A)^T D                                               (energy)
//   F(A)^T D  <=  epsilon sum_i (|external_i| + weight_i(A))        |d_i| <= epsilon, (6)
//   F(A)^T D  =   sum_j A_j l_j (gamma strain_j^2 + mu slip_j^2)  <=  sum_j A_j l_j (sigma^2 / gamma + tau^2
//   / mu)
//                                                                                       (2), (3)
//
// where external_i is force and skin weight together on the free axes of node i. K and F are linear in A, so
// for given y each line is linear in A, and so are the moments of balance (8). With multipliers >= 0 their
// sum S(A) is <= 0 for every feasible A, and
//
//   volume_weight sum A_j l_j  >=  min over the bounds of  volume_weight sum A_j l_j + S(A)  =:  value,
//
// a minimum strut by strut. volume_weight 1: value is a lower bound on the volume. volume_weight 0: value > 0
// proves that no areas within the bounds keep the limits. Whatever y and the multipliers are, the inequality
// is valid: nothing has to be solved to verify it.
//
// Used: displacement limit, stress limits (both strengths together, with the paper's element), balance, the
// bounds on the areas (radii and slenderness). Stress limits strut by strut would only tighten it.
// Units: mm, N, MPa.
#pragma once

#include <vector>

#include "worker/mechanics/equilibrium.h"
#include "worker/mechanics/frame_problem.h"

namespace skinframe {

struct AreaBox {
  std::vector<double> lower_mm2, upper_mm2;  // one a strut
};
// As area_bounds leaves them. `may_vanish`: struts whose lower bound is zero instead; one a strut, or empty.
AreaBox area_box(const FrameProblem& problem, const std::vector<bool>& may_vanish = {});

struct VirtualField {
  int load_case = 0;
  double displacement_multiplier = 0;  // of (6), >= 0; mm3 / (N mm), as the next
  double stress_multiplier = 0;        // of (2) and (3)
  NodeVectors displacements_mm;        // y, one a node; fixed axes are read as zero
};

struct DualProof {
  double volume_weight = 0;                 // 1 or 0, see above
  std::vector<VirtualField> fields;         // load cases that are not named do not take part
  std::vector<double> balance_multipliers;  // one a half plane, or empty; mm3 / (N mm)
  // Limits count as kept up to this: relative on (2), (3), (6), mm on (8). So the statement covers every
  // frame that the optimiser calls feasible.
  double feasibility_tolerance = 0;
};

struct DualValue {
  double value = 0;  // volume_weight 1: mm3
  // What the limits allow at the areas of the minimum: the multipliers times the right sides of (2), (3),
  // (6), and times 1 mm of the weight for (8). value / normalisation says by how much infeasible limits are
  // missed.
  double normalisation = 0;
};

// Precondition: sizes agree with the problem, multipliers >= 0.
DualValue dual_value(const FrameProblem& problem, const AreaBox& box, const DualProof& proof);

// Greatest energy per volume that the strengths allow: sigma^2 / gamma + tau^2 / mu in MPa; infinite where a
// strength that counts is not given.
double allowed_energy_density_mpa(const FrameProblem& problem, double feasibility_tolerance);

}  // namespace skinframe
