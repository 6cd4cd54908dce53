// SPDX-License-Identifier: GPL-3.0-or-later
// Fewer triangles for the same surface: a level set's mesh has as many on a flat wall as about a strut.
//
// Edges are collapsed in the order of their quadric error (Garland and Heckbert 1997, weighted by area, of
// the present surface as in Lindstrom and Turk 1998). What bounds the error is not the quadric but points of
// the surface as it was, each bound to the nearest of the triangles that took the place of its own (Klein,
// Liebich and Strasser 1996). A collapse is made only where
//   - every point stays within the deviation,
//   - the surface stays closed and edge-manifold (the ends share two neighbours exactly),
//   - no triangle turns far or becomes a sliver,
//   - the new triangles meet no other triangle of the mesh but where they share a corner or a side.
// It goes on in boxes of space at once, pass by pass with other boxes, so the result is the same at any
// number of threads.
#pragma once

#include <cstddef>

#include "worker/mesh/triangle_mesh.h"
#include "worker/run/run_context.h"
#include "worker/skin/triangle_tree.h"

namespace skinframe {

struct ThinningOptions {
  std::size_t triangles = 0;      // wanted; more stay where the deviation asks for them
  double max_deviation_mm = 0.0;  // > 0
  // False: only the root of the quadric error stays below the deviation. Neither points are followed then nor
  // is it asked whether triangles meet: several times as fast, for small steps.
  bool is_bounded = true;
  bool is_clear = false;    // true: whether triangles meet is asked all the same
  int exact_vertices = 0;   // the first so many vertices never move, they only go,
  bool exact_stay = false;  // and not even that
  // The mesh as it was. With it new triangles are held to it exactly wherever the points leave doubt; the
  // caller measures what came of it.
  const TriangleTree* original = nullptr;
};

struct Thinned {
  // Furthest that a corner of the mesh as it was (or the middle of one of its large triangles) is from the
  // triangles that took its place: at most max_deviation_mm. The other direction is not measured here.
  // 0 where it was not bounded.
  double deviation_mm = 0.0;
  int exact_vertices = 0;  // left of those, still the first
};

// The mesh must be closed and edge-manifold, and stays so; its Euler characteristic stays too. Pairs of
// triangles that cut each other may stay, new ones do not come. Triangles keep their order, vertices are
// rounded to floats where they move. Runs in the caller's task arena. Stops early, still closed, when the
// job is cancelled.
Thinned thin_out(TriangleMesh& mesh, const ThinningOptions& options, const RunContext& context);

}  // namespace skinframe
