// SPDX-License-Identifier: GPL-3.0-or-later
// A frame on its way through Algorithm 1: a problem whose struts and nodes grow fewer, with feasible areas
// and the way back to the input's indices. And how struts are taken out of it.
#pragma once

#include <string>
#include <vector>

#include "worker/mechanics/frame_problem.h"
#include "worker/optimize/optimize_frame.h"
#include "worker/optimize/warm_start.h"

namespace skinframe {

struct Design {
  FrameProblem problem;
  std::vector<double> areas_mm2;  // sized and feasible, one a strut
  double volume_mm3 = 0;
  // How the sizing that gave these areas ended.
  Termination reason = Termination::kOptimal;
  std::string detail;
  double kkt_error = 0;
  WarmStart warm;                              // duals of that sizing, or none
  std::vector<int> node_origin, strut_origin;  // in the input
};

// The problem as given, without areas.
Design initial_design(const FrameProblem& problem);

// The design with the struts of `keep`, and of those only what serves: components without a fixed node that
// neither belong to the skin nor carry a load go, and so do internal nodes that end up with a single strut,
// with that strut (it carries nothing), and supports that hold nothing any more. Areas are carried over;
// volume_mm3 is left at 0, since nothing has been sized.
Design reduced_design(const Design& design, std::vector<bool> keep);

// Struts that topology optimisation may remove: internal ones, and those whose lower bound is zero.
std::vector<bool> removable_struts(const FrameProblem& problem);

}  // namespace skinframe
