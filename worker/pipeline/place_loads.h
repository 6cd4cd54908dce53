// SPDX-License-Identifier: GPL-3.0-or-later
// From loads on the object to forces on the skin nodes. A load presses on a round patch of the skin; each bit
// of the patch hands its share to the corners of its triangle by barycentric weights, so that force and
// moment about the patch are kept whatever the spacing of the nodes.
#pragma once

#include <vector>

#include "worker/frame/frame.h"
#include "worker/mechanics/frame_problem.h"
#include "worker/pipeline/request.h"
#include "worker/solid/solid.h"
#include "worker/stress/stress_map.h"

namespace skinframe {

// The name of the load case that is always there: gravity alone.
inline constexpr const char* kSelfWeight = "self-weight";

// The middle of the connected part of the surface that stands within 1 mm of the furthest point in that
// direction.
Eigen::Vector3d place_point_mm(const Solid& solid, Place place);

// The loads by the points where they act, for the solid.
std::vector<StressLoad> loads_at_points(const std::vector<Load>& loads, const Solid& solid);

struct PlacedLoads {
  std::vector<LoadCase> cases;
  std::vector<std::string> warnings;  // a place whose nearest skin is far: it is thinner than two skins there
};

// The self-weight case, then one case a name in order of first use; gravity acts in all. Sums of force_n
// equal the sums of the loads. Error: kInvalidInput when a load's point is further than the patch's radius
// and 10 mm from the skin.
Result<PlacedLoads> place_loads(const std::vector<Load>& loads, const Solid& solid, const Frame& frame);

}  // namespace skinframe
