// SPDX-License-Identifier: GPL-3.0-or-later
// TopOpt (17-20): which struts the frame needs.
//
//   bare        no removable strut at all, the rest at its lower bounds: if that is feasible nothing is left
//   to do relaxed     minimum volume with A >= 0 on removable struts (kTight only) reweighted  minimum of sum
//   w_j A_j, w_j = 1 / (xi + A_j), volume <= cap: the convex stand-in for the number of struts
//
// Each is followed by a threshold, the removal of what no longer serves, and SizeOpt on what is left. If that
// is infeasible or larger than before, struts come back in descending area; if it still is, the step is
// dropped.
#pragma once

#include "worker/optimize/design.h"
#include "worker/optimize/session.h"

namespace skinframe {

// The design itself, or a sized one of no more volume (beyond kVolumeTie) with fewer struts. On cancellation:
// any of the two.
Design optimise_topology(Design design, Session& session);

}  // namespace skinframe
