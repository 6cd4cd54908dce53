// SPDX-License-Identifier: GPL-3.0-or-later
// Where the interior point stands: the point, and a slack and a dual for each inequality, c + s = 0 and z s =
// mu.
#pragma once

#include "worker/optimize/frame_program.h"

namespace skinframe {

struct Iterate {
  ProgramVector point;
  Eigen::VectorXd slacks, duals;  // positive
};

// Of the perturbed Karush-Kuhn-Tucker conditions: infinity norms, the dual and complementarity parts divided
// by the scale of the multipliers (Waechter and Biegler 2006, eq. 5).
struct KktError {
  double dual = 0;
  double primal = 0;
  double complementarity = 0;  // |z s - mu|
  double worst() const { return std::max({dual, primal, complementarity}); }
};
KktError kkt_error(const FrameProgram& program, const InequalityLayout& layout, const Iterate& iterate,
                   double barrier);

// The iterate at `point` with slacks that fit it, at least slack_floor, and duals barrier / slack. Areas and
// moving nodes are first pushed a little inside their bounds.
//
// known_duals: empty, or one an inequality, 0 where not known; together with the point's multipliers. Then
// each area stands off its bounds no further than the barrier's own solution does, barrier / |slope of the
// Lagrangian|, and the slack of an active limit is barrier / dual: a start near the central path.
Iterate start_iterate(const FrameProgram& program, const InequalityLayout& layout, ProgramVector point,
                      double barrier, const Eigen::VectorXd& known_duals = {});

// Slacks of linear inequalities (areas, half-spaces) follow the point exactly, the others grow where c leaves
// room.
void follow_point(const FrameProgram& program, const InequalityLayout& layout, Iterate& iterate);

}  // namespace skinframe
