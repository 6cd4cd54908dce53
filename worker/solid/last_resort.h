// SPDX-License-Identifier: GPL-3.0-or-later
// What is done with a surface that cannot be mended as it is: small openings are closed one by one, then the
// whole is wrapped. Before the openings are closed a wrap would enter them and follow the inside. Internal to
// the room.
#pragma once

#include <string>

#include "worker/mesh/triangle_mesh.h"
#include "worker/run/result.h"

namespace skinframe {

struct LastResortOptions {
  double max_opening = 0;  // boundary length, in mm: a longer opening is not closed
  // The wrap's volume may differ from what the surface shuts off by at most this share.
  double max_volume_change_relative = 0.05;
};

struct Wrapped {
  TriangleMesh mesh;
  std::string told;  // one sentence: why, how wide, and the volumes before and after
};

// `defect` is why the surface cannot be mended; it is told in the sentence and in every error. `mesh` is
// welded, in mm. kInvalidInput when an opening is too long, the surface is in so many
// parts or so large for its box that a wrap would take gigabytes, or the volume would change too much.
Result<Wrapped> wrap_as_last_resort(TriangleMesh mesh, const std::string& defect,
                                    const LastResortOptions& options);

}  // namespace skinframe
