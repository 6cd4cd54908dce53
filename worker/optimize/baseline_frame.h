// SPDX-License-Identifier: GPL-3.0-or-later
// What a baseline hands over, so that it can stand beside an OptimizeResult in a table.
#pragma once

#include <vector>

#include "worker/mechanics/evaluation.h"
#include "worker/mechanics/frame_problem.h"

namespace skinframe {

struct BaselineFrame {
  bool feasible = false;  // every constraint of the problem holds; else the frame that came nearest
  FrameProblem problem;   // with the struts that are left
  std::vector<double> radii_mm;
  Evaluation evaluation;                       // of radii_mm in problem, from scratch
  std::vector<int> node_origin, strut_origin;  // in the input
  int rounds = 0;                              // of removal, or linear solves of a search
  int interior_point_iterations = 0;
  int factorisations = 0;  // of the interior point's system

  double volume_mm3() const { return evaluation.frame_volume_mm3; }
};

}  // namespace skinframe
