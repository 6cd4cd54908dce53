// SPDX-License-Identifier: GPL-3.0-or-later
// Internal to the room; the header is free of OpenVDB.
#pragma once

#include "worker/sample/bodies.h"

namespace skinframe {

// The zero set of the body on a cubic grid, one vertex a cell that it crosses (dual contouring without
// adaptivity, which would self-intersect). Quadrangles are cut along their shorter diagonal. Outward.
TriangleMesh mesh_body(const Body& body);

}  // namespace skinframe
