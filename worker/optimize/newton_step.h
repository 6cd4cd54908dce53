// SPDX-License-Identifier: GPL-3.0-or-later
// What the linear system leaves out of a Newton step: the slacks and duals that were condensed.
#pragma once

#include "worker/optimize/kkt_system.h"

namespace skinframe {

// A Newton step of point, slacks and duals, with the step lengths that keep the fraction to the boundary.
struct NewtonStep {
  ProgramVector point;
  Eigen::VectorXd slacks, duals;
  double primal_length = 1, dual_length = 1;
};

// From c + s + J dp + ds = 0 and z s + s dz + z ds = mu. Lengths are left at 1.
NewtonStep complete_step(const FrameProgram& program, const InequalityLayout& layout, const Iterate& iterate,
                         double barrier, KktStep solved);

}  // namespace skinframe
