// SPDX-License-Identifier: GPL-3.0-or-later
// From the areas of a relaxed program to a sized frame with fewer struts. Struts that were left with next to
// nothing go; what is left is sized. Where that is infeasible or larger than allowed, struts come back in
// descending area, a larger share try after try.
#pragma once

#include <optional>
#include <vector>

#include "worker/optimize/design.h"
#include "worker/optimize/session.h"

namespace skinframe {

// A removable strut goes at A <= removal_share * its lower bound, or at next to no share of the mean area
// where that bound is zero. None: nothing goes, or no try is feasible, accepted by the caller and of at most
// (1 + kVolumeTie) * the design's volume; or cancelled.
std::optional<Design> without_thin_struts(const Design& design, const std::vector<double>& areas_mm2,
                                          double removal_share, Session& session);

// size_frame from areas near the optimum and with the design's duals; both become those of the result.
// False: cancelled, infeasible, or surely larger than `most_mm3`; the design is as it was.
bool size_again(Design& design, const std::vector<double>& hint_mm2, std::optional<double> most_mm3,
                Session& session);

double mean_area_mm2(const std::vector<double>& areas_mm2);

}  // namespace skinframe
