// SPDX-License-Identifier: GPL-3.0-or-later
// A surface cut open along a prism: the one sheet of it that crosses the prism loses what stands within.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <vector>

#include "worker/drain/opening.h"
#include "worker/mesh/triangle_mesh.h"

namespace skinframe {

// The prism has that many sides, its corners on the cylinder: a hole is narrower than the cylinder by 0.0012
// of its radius between them.
inline constexpr int kPrismSides = 64;

// From one try to the next: no share of a side's angle.
inline constexpr double kTurnRadians = 0.0137;
inline constexpr int kMostTurns = 5;

// About the prism at any turn: a cut touches no triangle whose box is clear of it.
Eigen::AlignedBox3d reach_of_cut(const Opening& opening);

struct CutSheet {
  // Numbers name the vertices of the mesh and, behind them, those in `added`.
  std::vector<Eigen::Vector3d> added;           // exact floats
  std::vector<int> gone;                        // triangles that the cut touches, ascending
  std::vector<std::array<int, 3>> around, lid;  // what they become, outside and inside of the prism
  std::vector<int> loop;                        // the lid's rim, counter-clockwise as the lid is
  std::vector<double> angles;                   // of the loop's vertices about the axis, ascending from 0
};

// `turn`: of the prism about its axis, in radians. None where what crosses the prism is not a single disc,
// seen from outside a graph over the prism's section, that ends at its sides; and where an angle or a
// triangle is lost in rounding (another turn may do).
std::optional<CutSheet> cut_sheet(const TriangleMesh& mesh, const Opening& opening, double turn);

// The mesh without the lid: `gone` out, `around` and `added` at the end. Returns the number of triangles.
void remove_lid(TriangleMesh& mesh, const CutSheet& cut);

}  // namespace skinframe
