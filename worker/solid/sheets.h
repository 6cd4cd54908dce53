// SPDX-License-Identifier: GPL-3.0-or-later
// Sheets without thickness that hang on a body: fins outside of it, walls within. Internal to the room.
#pragma once

#include <cstddef>

#include "worker/mesh/triangle_mesh.h"

namespace skinframe {

struct SheetCounts {
  std::size_t fins = 0;   // triangles of sheets that end in the open
  std::size_t walls = 0;  // triangles of sheets that part a body from within
};

// A patch is what hangs together across edges of two triangles; where three, five, ... meet, one patch is too
// many. Drops the fins there, and of the others the patch without which the rest encloses most. Leaves edges
// of four, six, ... triangles, where bodies touch, alone.
SheetCounts drop_sheets(TriangleMesh& mesh);

}  // namespace skinframe
