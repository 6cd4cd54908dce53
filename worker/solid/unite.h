// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies that overlap become one. Internal to the room.
#pragma once

#include <string>
#include <vector>

#include "worker/mesh/triangle_mesh.h"
#include "worker/run/result.h"
#include "worker/run/run_context.h"

namespace skinframe {

struct UniteOptions {
  // A surface that crosses itself, and that the library cannot clean, is left as it is while the volume that
  // it shuts off from outside differs from the one that its triangles sum up to by at most this share; above,
  // it is united with itself.
  double max_self_overlap_relative = 0.01;
  bool exact = true;  // false: level sets only
};

struct Union {
  TriangleMesh mesh;
  bool changed = false;
  std::vector<std::string> repairs, warnings;
};

// Expects closed shells, bodies looking outward and cavities inward, in mm. Bodies whose surfaces cross are
// united exactly where the library can, else in a level set; a cavity is what is left of it. Error:
// kCancelled.
Result<Union> unite_overlaps(const TriangleMesh& mesh, const UniteOptions& options,
                             const RunContext& context);

}  // namespace skinframe
