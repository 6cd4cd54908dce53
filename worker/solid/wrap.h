// SPDX-License-Identifier: GPL-3.0-or-later
// The one call of CGAL's alpha wrap (Portaneri, Rouxel-Labbe, Hemmer, Cohen-Steiner, Alliez, "Alpha wrapping
// with an offset", 2022); the header is free of CGAL. Internal to the room.
#pragma once

#include <optional>

#include "worker/mesh/triangle_mesh.h"

namespace skinframe {

// A closed surface without self-intersection around all triangles, `offset` away from them, that enters
// nothing narrower than a ball of radius `alpha`. Empty when the library gives up.
std::optional<TriangleMesh> wrap_around(const TriangleMesh& mesh, double alpha, double offset);

}  // namespace skinframe
