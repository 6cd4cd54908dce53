// SPDX-License-Identifier: GPL-3.0-or-later
// The smallest uniform radius, clipped to each strut's bounds, that keeps (2), (3) and (6): where SizeOpt
// starts. Starting at the upper bounds fails: a heavy frame sags under its own weight and every multiplier
// starts wrong.
#pragma once

#include <vector>

#include "worker/mechanics/equilibrium.h"
#include "worker/mechanics/frame_problem.h"

namespace skinframe {

struct UniformStart {
  std::vector<double> areas_mm2;
  double utilisation = 0;  // <= 1: feasible; else the best uniform radius found
};

UniformStart uniform_start(const FrameProblem& problem, const std::vector<double>& lower_mm2,
                           const std::vector<double>& upper_mm2, EquilibriumSolver& solver);

}  // namespace skinframe
