// SPDX-License-Identifier: GPL-3.0-or-later
// The steps of repair(), each of which says what it did. Internal to the room. `diagonal` is that of the
// bounding box of the mesh as it came, in mm: tolerances are relative to it.
#pragma once

#include <string>
#include <vector>

#include "worker/mesh/triangle_mesh.h"
#include "worker/run/result.h"
#include "worker/solid/repair.h"
#include "worker/solid/solid.h"

namespace skinframe {

using Sentences = std::vector<std::string>;

// Welds with the smallest tolerance that closes the mesh or, where none does, leaves the fewest open edges.
void weld_until_closed(TriangleMesh& mesh, const RepairOptions& options, double diagonal, Sentences& repairs);

// Closes cracks without width.
void stitch(TriangleMesh& mesh, double diagonal, Sentences& repairs);

void remove_duplicates(TriangleMesh& mesh, Sentences& repairs);

// From welded triangles a surface of at most two triangles an edge that is one-sided nowhere. `senses_kept`:
// no triangle had to be turned, so the file's own senses can be trusted.
Status straighten(TriangleMesh& mesh, double diagonal, bool& senses_kept, Sentences& repairs);

// From a straight surface to a solid. `large_opening` is set where the error is one that a wrap must not
// hide.
Result<Solid> close(TriangleMesh mesh, const RepairOptions& options, double diagonal, bool senses_kept,
                    bool& large_opening, Sentences& repairs);

}  // namespace skinframe
