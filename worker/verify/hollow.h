// SPDX-License-Identifier: GPL-3.0-or-later
// The body hollowed uniformly: what anyone gets from a slicer, and so what a skin-frame is compared with.
#pragma once

#include <vector>

#include "worker/skin/triangle_tree.h"
#include "worker/verify/fine_skin.h"

namespace skinframe {

// Wall thickness at which the hollowed body has `volume_mm3`: what lies less deep than it below M, found by
// search in the depths of a lattice of points. Of the body's half-thickness where the volume is the solid's.
double equal_volume_wall_mm(const Skin& skin, double solid_volume_mm3, double volume_mm3);

// One a node of the fine skin: the wall, or half of the body's thickness there where that is less (two walls
// that meet are solid).
std::vector<double> local_walls_mm(const FineSkin& fine, const Skin& skin, const TriangleTree& body,
                                   double wall_mm);

}  // namespace skinframe
