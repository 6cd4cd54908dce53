// SPDX-License-Identifier: GPL-3.0-or-later
// The printable mesh with fewer triangles, for slicers that are slow on many: closed and edge-manifold like
// the full one, free of crossings that it does not have, and as near to it as the report says.
//
// Corners of M never move: where M is flat, or the deviation allows it, they go (thin_out.h). Where M has few
// triangles beside what is wanted it stays as it is.
#pragma once

#include <cstddef>

#include "worker/export/printable.h"
#include "worker/mesh/triangle_mesh.h"
#include "worker/run/run_context.h"

namespace skinframe {

struct CompactOptions {
  std::size_t triangles = 100'000;  // wanted; more stay where the deviation asks for them
  double max_deviation_mm = 0.25;   // > 0
};

struct CompactMesh {
  TriangleMesh mesh;  // the outer surface first
  std::size_t outer_triangles = 0;
  double volume_mm3 = 0.0;
  // Furthest that a corner of either mesh, or a middle of a triangle of the compact one or of a large one of
  // the full one, is from the other; never less than that, and never above what is allowed.
  double deviation_mm = 0.0;
  int crossings_left = 0;  // pairs of triangles that cut each other, but those where both are M's own
};

// outer_triangles: of the printable mesh, the first ones, which use the first vertices. Errors: kCancelled.
Result<CompactMesh> make_compact(const PrintableMesh& printable, std::size_t outer_triangles,
                                 const CompactOptions& options, const RunContext& context);

}  // namespace skinframe
