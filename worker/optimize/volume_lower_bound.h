// SPDX-License-Identifier: GPL-3.0-or-later
// A lower bound on the frame volume for fixed nodes and struts, from the convex relaxation
// (convex_relaxation.h): no areas within the box that keep the limits used there have less volume.
// Slenderness enters as part of the box, balance and the displacement limit as terms; what is not used
// (stress limits of single struts, load cases beyond kMostBoundCases) could only raise the bound.
//
// Guarantees: value_mm3 = dual_value(problem, box, proof).value, computed in mm and N from the proof alone,
// less kBoundRounding of itself for rounding; never below that of all struts at their lower bounds. It is a
// bound however the search for it ended.
#pragma once

#include <functional>

#include "worker/optimize/dual_proof.h"

namespace skinframe {

inline constexpr int kMostBoundCases = 3;
inline constexpr int kMostBoundHalfPlanes = 8;
inline constexpr double kBoundRounding = 1e-11;

struct BoundRequest {
  AreaBox box;
  std::vector<double> start_mm2;  // a sized frame, or near one
  double volume_mm3 = 0;          // of the best frame known: the search ends where the bound meets it
  double feasibility_tolerance = 0;
  std::function<bool()> cancelled = [] { return false; };
};

struct VolumeBound {
  double value_mm3 = 0;
  DualProof proof;
  int iterations = 0;
};

VolumeBound volume_lower_bound(const FrameProblem& problem, const BoundRequest& request);

}  // namespace skinframe
