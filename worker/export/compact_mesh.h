// SPDX-License-Identifier: GPL-3.0-or-later
// The printable mesh with fewer triangles, for slicers that are slow on many: closed and edge-manifold like
// the full one, and as near to it as the report says.
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
  double deviation_mm = 0.0;  // furthest that a corner or middle of either mesh was found from the other
  int crossings_left = 0;     // pairs of triangles of the thinned parts that cut each other
};

// outer_triangles: of the printable mesh, the first ones; they stay as they are while they are fewer than
// half of what is wanted. Errors: kCancelled.
Result<CompactMesh> make_compact(const PrintableMesh& printable, std::size_t outer_triangles,
                                 const CompactOptions& options, const RunContext& context);

}  // namespace skinframe
