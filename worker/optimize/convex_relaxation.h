// SPDX-License-Identifier: GPL-3.0-or-later
// The convex problem behind every dual proof (see dual_proof.h), in nondimensional numbers of order one:
//
//   minimise    cost . A      over lower <= A <= upper
//   subject to  F_k(A)^T K(A)^-1 F_k(A) + constant_c + slope_c . A  <=  0     each energy term c of load case
//   k
//               constant_c + slope_c . A                            <=  0     each balance term c
//
// convex, since F^T K^-1 F is (Boyd and Vandenberghe 2004, example 3.4). With the fields w_k = u_k y_k, u_k
// the sum of load case k's multipliers t_c, it is the saddle point
//
//   min_A max_{w, t >= 0}  cost . A + sum_k (2 F_k(A) . w_k - w_k^T K(A) w_k / u_k)
//                          + sum_c t_c (constant_c + slope_c . A),
//
// linear in A, jointly concave in (w, t), and homogeneous in (w, t) but for the cost.
#pragma once

#include <Eigen/Core>
#include <array>
#include <utility>
#include <vector>

#include "worker/optimize/dual_proof.h"

namespace skinframe {

enum class TermKind { kDisplacement, kStress, kBalance };

struct RelaxedTerm {
  TermKind kind = TermKind::kDisplacement;
  int load_case = -1;  // index in Relaxation::load_cases; -1 for balance
  int half_plane = -1;
  double constant = 0;
  Eigen::VectorXd slope;  // one a strut
  double unit = 1;        // of the term, N mm
};

struct Relaxation {
  std::vector<std::pair<int, int>> struts;
  std::vector<std::array<bool, 3>> fixed;
  Eigen::VectorXd lower, upper, cost;
  std::vector<Eigen::Matrix3d> stiffness;  // one a strut, of unit area
  Eigen::VectorXd half_weight;             // one a strut, of unit area
  std::vector<int> load_cases;             // in the problem
  std::vector<double> gravity;             // 1 or 0, one a load case here
  Eigen::VectorXd external;                // full vector: entry 3 (cases * node + case) + axis
  std::vector<RelaxedTerm> terms;
  double feasibility_tolerance = 0, volume_weight = 0;
  double area_mm2 = 1, displacement_mm = 1, volume_mm3 = 1;  // units

  int strut_count() const { return static_cast<int>(struts.size()); }
  int case_count() const { return static_cast<int>(load_cases.size()); }
  int term_count() const { return static_cast<int>(terms.size()); }
  bool area_is_given(int j) const { return !(lower[j] < upper[j]); }
};

struct RelaxationRequest {
  std::vector<int> load_cases;   // those that take part
  std::vector<int> half_planes;  // of balance, likewise
  double volume_weight = 0;      // 1: a bound on the volume; 0: a proof of infeasibility
  double feasibility_tolerance = 0;
  std::vector<double> start_mm2;        // sets the units
  std::vector<CaseResponse> responses;  // at start_mm2, one a load case that takes part
};

Relaxation relax(const FrameProblem& problem, const AreaBox& box, const RelaxationRequest& request);

// A point of the saddle: areas, fields w as a full vector, multipliers of the terms.
struct SaddlePoint {
  Eigen::VectorXd areas, fields, multipliers;
};

// The gradient of the saddle function in A but for the cost: `slope`, with its value at A = 0.
struct DualForm {
  double constant = 0;
  Eigen::VectorXd slope;
};
DualForm dual_form(const Relaxation& relaxation, const SaddlePoint& point);

// min over the bounds of cost . A + scale (constant + slope . A).
double least_over_box(const Relaxation& relaxation, const DualForm& form, double scale);

// The scale >= 0 with the greatest such minimum, which is concave in it, and that minimum.
std::pair<double, double> best_scale(const Relaxation& relaxation, const DualForm& form);

// In mm and N, the fields and multipliers times `scale`.
DualProof proof_of(const Relaxation& relaxation, const SaddlePoint& point, double scale,
                   std::size_t half_planes);

}  // namespace skinframe
