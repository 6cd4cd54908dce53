// SPDX-License-Identifier: GPL-3.0-or-later
// K(A) D = F(A), eq. (1): displacements, strut stresses and reactions of a frame with given areas.
// K is factorised by CHOLMOD (supernodal), apart from the optimiser's own factorisation, so that the one
// checks the other.
//
// A node without stiffness (a mechanism of the axial element, a node whose struts have all vanished) leaves K
// singular. K + kRegularisation * (largest diagonal) * I is factorised and the answer refined against K
// itself; `residual` is that of K. Where the load does not excite the mechanism it is at rounding level;
// where it does, no refinement helps, residual exceeds kResidualLimit and `in_equilibrium` is false. Nothing
// is hidden.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "worker/mechanics/frame_problem.h"

namespace skinframe {

using NodeVectors = std::vector<Eigen::Vector3d>;  // one a node

struct CaseResponse {
  NodeVectors displacements_mm;
  NodeVectors reactions_n;               // at fixed axes, what the support does to the frame; zero elsewhere
  std::vector<double> axial_stress_mpa;  // (2): gamma (e . delta) / l^2, tension positive, one a strut
  std::vector<double>
      shear_stress_mpa;  // (3): mu |delta - (e . delta) e / l^2| / l; zero for the axial element
  double max_displacement_mm = 0;
  double residual = 0;          // |K D - F|_inf / max(|F|_inf, tiny), over free axes
  bool in_equilibrium = false;  // residual <= kResidualLimit
};

inline constexpr double kRegularisation = 1e-12;
inline constexpr double kResidualLimit = 1e-6;

// The symbolic analysis is done once a frame; areas may change from solve to solve. Positions may not.
class EquilibriumSolver {
 public:
  explicit EquilibriumSolver(const FrameProblem& problem);  // keeps a reference: problem must outlive it
  ~EquilibriumSolver();
  EquilibriumSolver(EquilibriumSolver&&) noexcept;

  // One response a load case. Areas in mm2, one a strut.
  std::vector<CaseResponse> solve(const std::vector<double>& areas_mm2);
  // The same for the load cases named, in that order.
  std::vector<CaseResponse> solve(const std::vector<double>& areas_mm2, const std::vector<int>& cases);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

// One solve without keeping the analysis.
std::vector<CaseResponse> solve_equilibrium(const FrameProblem& problem,
                                            const std::vector<double>& areas_mm2);

// External forces, half of each strut's weight at either end, and the skin's weight, in N: F of (1), supports
// included.
NodeVectors nodal_loads_n(const FrameProblem& problem, const std::vector<double>& areas_mm2, int load_case);

std::vector<double> areas_of(const std::vector<double>& radii_mm);
std::vector<double> radii_of(const std::vector<double>& areas_mm2);

}  // namespace skinframe
