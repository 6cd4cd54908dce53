// SPDX-License-Identifier: GPL-3.0-or-later
// What is printed: M minus a cavity, the cavity being M1 minus the struts.
//
// The outer surface is M's own triangles, untouched and first in the list; behind them stands the cavity's
// boundary, reversed, taken from one level set max(distance to M + h_S, -(distance to the nearest strut axis
// - r)); where fine detail is smoothed, M1 is what lies deeper than h_S below both M and the copy. So struts
// are clipped to M1, nothing ever comes nearer than about h_S to M from within, and parts too thin for a
// cavity are solid, as are gaps narrower than a voxel between a strut and the wall or another strut.
//
// Guarantees, on the coordinates rounded to float as a binary STL stores them:
//  1. Every edge has exactly two triangles, in opposite directions (when that holds for M).
//  2. No triangle has two equal corners.
//  3. The cavity's triangles cut neither each other nor M's, unless crossings_left says so.
//  4. volume_mm3 = volume of M - cavity_volume_mm3, both of the mesh as it is.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "worker/frame/frame.h"
#include "worker/mesh/triangle_mesh.h"
#include "worker/run/run_context.h"
#include "worker/skin/build_skin.h"

namespace skinframe {

struct ExportOptions {
  std::optional<double> voxel_mm;  // default 0.6 of the smallest radius, coarser on large bodies
  std::size_t max_triangles =
      800'000;                       // of the cavity: thinned to this within 0.1 voxel (rms); 0 = not thinned
  double smallest_pocket_mm3 = 1.0;  // sealed pockets below are filled, >= 0
  Status validate() const;
};

struct PrintableMesh {
  TriangleMesh mesh;  // coordinates are exact floats
  double volume_mm3 = 0.0;
  double cavity_volume_mm3 = 0.0;
  double voxel_mm = 0.0;
  int pockets = 0;  // cavity pieces that stay
  int pockets_filled = 0;
  int crossings_left = 0;  // pairs of triangles that cut each other, not both M's; 0 but in rare cases
  std::map<std::string, double> seconds;  // of the steps
};

// radii_mm: one a strut of the frame. Errors: kInvalidInput for an option out of range or a grid too large;
// kCancelled.
Result<PrintableMesh> merge_solid(const Solid& solid, const Skin& skin, const Frame& frame,
                                  const std::vector<double>& radii_mm, const ExportOptions& options,
                                  RunContext& context);

// The same for a mesh that the caller knows to be closed and outward: the one that the skin was built from.
Result<PrintableMesh> merge_solid(const TriangleMesh& closed_mesh, const Skin& skin, const Frame& frame,
                                  const std::vector<double>& radii_mm, const ExportOptions& options,
                                  RunContext& context);

}  // namespace skinframe
