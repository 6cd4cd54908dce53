// SPDX-License-Identifier: GPL-3.0-or-later
// From what a file holds to a Solid, by the least change that closes it: weld, drop duplicates and
// degenerate triangles, orient, drop sheets without thickness, part what touches only along an edge, fill
// small holes, turn outward, unite bodies that overlap.
//
// What cannot be closed is kInvalidInput with a sentence that names the defect (open boundary: how many, the
// longest, where; non-orientable; encloses no volume). A large opening is only capped where a plane cut the
// body off, and that is told. Slight self-intersections are accepted and told in a warning with what they
// change. Where a surface with small openings cannot be mended as it is, it is wrapped as a last resort, if
// its volume stays; the sentence says so.
#pragma once

#include <string>
#include <vector>

#include "worker/mesh/triangle_mesh.h"
#include "worker/run/result.h"
#include "worker/run/run_context.h"
#include "worker/solid/solid.h"

namespace skinframe {

struct RepairOptions {
  // Vertices closer than this times the diagonal of the bounding box become one. In [0, 1e-2].
  double weld_tolerance_relative = 1e-6;
  // A weld at the tolerance above that leaves the mesh open is tried again with a tolerance ten times
  // as large, up to this one, unless it would collapse more than 1 % of the triangles.
  // In [weld_tolerance_relative, 1e-2].
  double max_weld_tolerance_relative = 1e-4;
  // A hole is filled when its boundary is not longer than this times the diagonal. In [0, 1].
  double max_hole_relative = 0.1;
  // The same for a hole that is a flat cut through the whole body. The rim of a vessel is longer. In [0, 1].
  double max_flat_cut_relative = 1.0;
  // Shells whose box diagonal is below this times the whole diagonal are dropped when they are open or
  // enclose next to nothing. In [0, 0.1].
  double max_debris_relative = 1e-3;
  // Looking for overlaps costs about a second per 500k triangles.
  bool unite_overlaps = true;
  // A surface that crosses itself is left as it is while the volume that is enclosed twice or inside out is
  // at most this share of it. In [0, 1].
  double max_self_overlap_relative = 0.01;
  // Of a wrap. In [0, 1]; 0: never wrapped.
  double max_wrap_volume_change_relative = 0.05;

  Status validate() const;
};

struct RepairOutcome {
  Solid solid;
  std::vector<std::string> repairs;   // one sentence each, with a count: "welded 12 vertices within 0.0003"
  std::vector<std::string> warnings;  // what was accepted as it is
};

Result<RepairOutcome> repair(TriangleMesh mesh, const RepairOptions& options, RunContext& context);

}  // namespace skinframe
