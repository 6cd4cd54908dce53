// SPDX-License-Identifier: GPL-3.0-or-later
// The bodies themselves, about 200 mm large, standing on z = 0. Internal to the room.
#pragma once

#include <vector>

#include "worker/mesh/triangle_mesh.h"
#include "worker/sample/implicit.h"
#include "worker/sample/make_sample.h"

namespace skinframe {

struct Body {
  SampleInfo info;
  Implicit surface;
  BoundingBox box;      // holds the body
  double voxel_mm = 2;  // of the grid it is meshed on
};

std::vector<Body> sample_bodies();

}  // namespace skinframe
