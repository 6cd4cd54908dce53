// SPDX-License-Identifier: GPL-3.0-or-later
// Frames for tests: small ones written by hand, and a deterministic egg that looks like what sampling makes.
#pragma once

#include "worker/mechanics/frame_problem.h"
#include "worker/optimize/optimize_frame.h"

namespace skinframe::testing {

Material pa_plastic();  // Table 1, P-1

// An ellipsoid cut flat at z = 0: a geodesic skin of 10 f^2 + 2 nodes, internal nodes spread by best
// candidates, each joined to its nearest neighbours. Stands on its flat: z of the base is fixed, and the
// least that stops motion in the plane.
struct Egg {
  int frequency = 3;  // skin nodes: 10 f^2 + 2
  int internal_nodes = 20;
  int neighbours = 8;
  double height_mm = 180;
  double skin_thickness_mm = 1.0;
};
FrameProblem make_egg(const Egg& egg);

// Three struts in a line of 90 mm, fixed at one end, pulled at the other; displacement limit 0.05 mm.
FrameProblem pulled_chain(double force_n);

// The ten-bar truss of the textbooks in inches, kips and ksi: stress limit 25, areas from 0.1 in2. The least
// weight at 0.1 lb/in3 is 1593.2 lb, and with displacements limited to 2 in as well 5060.9 lb.
FrameProblem ten_bar_truss();

// SizeOpt alone, expected to come to an end.
OptimizeResult size_only(const FrameProblem& problem);

// A load case of gravity and a force shared by the topmost nodes.
LoadCase top_load(const FrameProblem& problem, const std::string& name, const Eigen::Vector3d& force_n);

// The hull of the nodes at z = 0, shrunk by margin_mm, as the half-planes of (8).
std::vector<HalfPlane> base_hull(const Frame& frame, double margin_mm);

}  // namespace skinframe::testing
