// SPDX-License-Identifier: GPL-3.0-or-later
// TopOpt (17-20): which struts the frame needs. Removable are internal struts and those whose lower bound is
// zero; in the programs here their areas may shrink to nothing.
//
//   bare        no removable strut at all, the rest at its lower bounds: if that is feasible nothing is left
//   to do relaxed     minimum volume; then once more with each removable strut's length weighed by
//               max(1, (lower + xi) / (A + xi)): a strut costs what it will cost once it stands at its lower
//               bound or is gone (where rounded_up is asked for). kTight only.
//   reweighted  minimum of sum w_j A_j, w_j = xi / (xi + A_j), volume <= cap: the convex stand-in for the
//   number
//               of struts (17), with as many reweightings as the options say
//
// Relaxed and reweighted are each followed by a threshold, the removal of what no longer serves, SizeOpt on
// what is left, and the return of struts in descending area (restore_struts.h). A step whose sized frame is
// infeasible or larger than the one before is dropped. Reweighted is left out where the relaxed optimum, a
// bound (local, as all of this is) on what any choice of these struts can reach, leaves less than kNoRoom to
// gain.
//
// kPaper is the printed order: reweighted alone, from SizeOpt's frame, capped at SizeOpt's volume. Where it
// departs from (17)-(20): the sum is linear in A and not in r, since r's slope at zero and xi = 1e-7 end
// every solver tried far from an optimum; xi is a share of the mean area; weights stay fixed during a
// program; and a strut goes at a share of its lower bound, not at r = zeta, since between the two no strut
// can be printed.
#pragma once

#include "worker/optimize/design.h"
#include "worker/optimize/session.h"

namespace skinframe {

inline constexpr double kNoRoom = 1e-3;  // relative, of the volume

// rounded_up: the relaxed program is solved a second time with those weights. Struts between nothing and
// their lower bound that a threshold lets stay are room for the geometry that follows: before its first round
// they are worth more than their volume.
//
// The design itself, or a sized one of no more volume (beyond kVolumeTie) with fewer struts. On cancellation:
// any of the two.
Design optimise_topology(Design design, bool rounded_up, Session& session);

}  // namespace skinframe
