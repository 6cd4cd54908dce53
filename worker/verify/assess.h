// SPDX-License-Identifier: GPL-3.0-or-later
// One structure under loads and pinches: what of it goes into a comparison.
#pragma once

#include "worker/mechanics/frame_problem.h"
#include "worker/structure/solve_structure.h"
#include "worker/verify/pinch.h"
#include "worker/verify/verification.h"

namespace skinframe {

struct Assessment {
  DesignFigures figures;       // weight_g nominal
  NodalColumns displacements;  // one column a load case
  Balance balance;             // of load cases and pinches
  std::optional<double> euler_factor;
  int euler_strut = -1;
};

// load_cases: forces on the fine skin's nodes, which are the structure's first. Errors: kInternal where
// forces and reactions do not balance to kBalanceTolerance, or the buckling factor does not converge; of the
// second those of StructureSolver::factorise too.
Result<Assessment> assess(const StructureSolver& solver, const FineSkin& fine,
                          const std::vector<LoadCase>& load_cases, const std::vector<PinchSite>& pinches,
                          const RunContext& context);
Result<Assessment> assess(const Structure& structure, const FineSkin& fine,
                          const std::vector<LoadCase>& load_cases, const std::vector<PinchSite>& pinches,
                          const RunContext& context);

// Work of the external forces of each load case, for the mesh's error estimate; of its weight where only that
// acts.
std::vector<double> load_works(const StructureSolver& solver, const std::vector<LoadCase>& load_cases);

}  // namespace skinframe
