// SPDX-License-Identifier: GPL-3.0-or-later
// Which load cases and half planes of balance a convex relaxation takes in: those that bind at given areas,
// the greatest demand first.
#pragma once

#include "worker/optimize/convex_relaxation.h"

namespace skinframe {

struct CriticalTerms {
  std::vector<int> load_cases, half_planes;
  std::vector<CaseResponse> responses;  // one a load case named
};

// Load cases whose demand is at least `binding_share` of the limit, and the first in any case; infinite where
// the frame is a mechanism, whose responses are then out of equilibrium. Half planes that the centre of
// gravity is nearest to.
CriticalTerms critical_terms(const FrameProblem& problem, const std::vector<double>& areas_mm2,
                             double binding_share, int most_cases, int most_half_planes);

// The displacements of the load cases of the relaxation as its full vector, nondimensional.
Eigen::VectorXd stacked_displacements(const Relaxation& relaxation, const CriticalTerms& critical);

}  // namespace skinframe
