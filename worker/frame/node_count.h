// SPDX-License-Identifier: GPL-3.0-or-later
// How long the edges of the skin triangulation may be, and so how many skin nodes there are.
//
// Finger rule: a finger of force f on a skin triangle must not bend it by more than epsilon. The skin as a
// plate of thickness h_S clamped on the triangle's inscribed circle (the paper's own formula ignores bending
// and gives 370 mm):
//     a <= sqrt(12) sqrt(16 pi B epsilon / f),   B = gamma h_S^3 / (12 (1 - nu^2))
// Chord rule: the chord of an edge must not leave M1 by more than h_S:
//     a(x) = sqrt(8 R(x) h_S),   R = least radius of normal curvature, smoothed over about the edge's length.
// Count: N = integral over M1 of 2 / (sqrt(3) min(a_finger, a(x))^2) dA.
#pragma once

#include <vector>

#include "worker/mesh/triangle_mesh.h"
#include "worker/run/result.h"
#include "worker/stress/stress_map.h"

namespace skinframe {

// What the finger rule needs of the material and the limits.
struct SkinPlate {
  double tensile_modulus_mpa = 0.0;     // gamma, > 0
  double poisson_ratio = 0.35;          // nu, in [0, 0.5)
  double displacement_limit_mm = 0.05;  // epsilon, > 0
  double finger_force_n = 10.0;         // f, > 0
};

double finger_edge_mm(const SkinPlate& plate, double skin_thickness_mm);

constexpr int kMinSkinNodes = 12;
constexpr int kMaxSkinNodes = 20000;

// The wanted edge length at every vertex of M1, within [kEdgeFloorInThicknesses h_S, a_finger]. Curvature is
// smoothed over kSmoothingInThicknesses h_S, about half of a short edge, and the floor keeps creases and
// relief from asking for what the skin cannot feel: there chords do leave M1 by more than h_S. Lengths change
// by at most kEdgeGrading mm a mm.
constexpr double kEdgeFloorInThicknesses = 5.0;
constexpr double kSmoothingInThicknesses = 4.0;
constexpr double kEdgeGrading = 0.6;
std::vector<double> edge_length_field(const TriangleMesh& inner_surface, double finger_edge_mm,
                                      double skin_thickness_mm);

// Node density follows the stress too (Wang et al. 2013, section 4.2). Stress is very skewed, so it is
// compressed: a factor on the density, (s / s0)^kStressExponent within [kLeastStressFactor,
// kMostStressFactor], s0 the geometric mean over the area; 1 where no stress is known. Edges become
// a / sqrt(factor), a_finger at most.
constexpr double kStressExponent = 0.25;
constexpr double kLeastStressFactor = 0.7, kMostStressFactor = 2.0;
void weigh_by_stress(const TriangleMesh& inner_surface, const StressMap& stress, double finger_edge_mm,
                     std::vector<double>& edge_length_mm);

// The integral above, vertex areas being a third of the triangles about; not rounded.
double node_demand(const TriangleMesh& inner_surface, const std::vector<double>& edge_length_mm);

}  // namespace skinframe
