// SPDX-License-Identifier: GPL-3.0-or-later
// Size and attitude of a mesh on the plate. Pure functions; each is a similarity, so closedness and
// orientation stay. Order of the pipeline: scale_to_largest_edge, turn_up, put_on_plate, repair (which rounds
// to float, finest near the origin).
#pragma once

#include "worker/mesh/triangle_mesh.h"

namespace skinframe {

// The axis of the file that points away from the plate.
enum class Up { kX, kY, kZ };

// Uniform scale so that the largest edge of the bounding box is size_mm (> 0). A mesh without extent is
// returned as it is.
TriangleMesh scale_to_largest_edge(TriangleMesh mesh, double size_mm);

// Proper rotation that takes the axis `up` to +z (kY: x stays, kX: y stays).
TriangleMesh turn_up(TriangleMesh mesh, Up up);

// Translation: lowest z becomes 0, the bounding box is centred on the origin in x and y.
TriangleMesh put_on_plate(TriangleMesh mesh);

}  // namespace skinframe
