// SPDX-License-Identifier: GPL-3.0-or-later
// The connected parts of a surface: which of them is debris, a body, a cavity. Internal to the room.
#pragma once

#include <cstddef>
#include <vector>

#include "worker/mesh/triangle_mesh.h"
#include "worker/run/result.h"

namespace skinframe {

struct Shell {
  std::vector<int> triangles;
  BoundingBox box;
  double volume = 0;  // signed; about the box's corner
  bool closed = true;
};

// Triangles that share an edge are of one shell. In the order of their first triangles.
std::vector<Shell> find_shells(const TriangleMesh& mesh);

// Whether `outer`, which is closed, has all of `inner` within it; shells that merely cross do not.
bool contains(const TriangleMesh& mesh, const Shell& outer, const Shell& inner);

// Drops open shells whose box diagonal is at most `size`. Returns how many.
std::size_t drop_small_open_shells(TriangleMesh& mesh, double size);

// Drops closed shells that enclose less than `volume` (a sheet drawn double encloses nothing). Returns how
// many.
std::size_t drop_empty_shells(TriangleMesh& mesh, double volume);

// Nesting compares shells in pairs: a mesh of more shells than this is refused.
inline constexpr std::size_t kMostShells = 10'000;

struct NestingCounts {
  std::size_t turned = 0;     // shells turned round
  std::size_t cavities = 0;   // shells that look inward
  std::size_t swallowed = 0;  // dropped: they lie wholly in the material of another and bound nothing
};

// Turns closed shells so that the material lies inside. Where the file's senses can be trusted, a shell
// within another is a cavity when it looks the other way and is swallowed when it looks the same way (the
// non-zero rule of slicers); otherwise depth alone decides (even: body, odd: cavity).
// Error: more than kMostShells.
Result<NestingCounts> nest_shells(TriangleMesh& mesh, bool trust_file_senses);

}  // namespace skinframe
