// SPDX-License-Identifier: GPL-3.0-or-later
// Where drain holes go: before nodes are sampled, where the skin is flat, low in stress and hidden below.
//
// Of sites spread evenly over M those are kept where M, within the hole's rim and some way beyond, is a
// single sheet whose normals stay near to the axis, with room in the cavity below for half the hole's
// diameter. Each costs
//     (1 + axis_z) / 2 + kFlatCost * height / radius + kStressCost * rank of its stress among all sites,
// and the cheapest is taken; a further one of the same cavity pays for being near to the first ones.
#pragma once

#include <string>
#include <vector>

#include "worker/drain/opening.h"
#include "worker/mesh/triangle_mesh.h"
#include "worker/run/run_context.h"
#include "worker/skin/build_skin.h"
#include "worker/solid/contact.h"
#include "worker/stress/stress_map.h"

namespace skinframe {

struct OpeningRule {
  double diameter_mm = 0;        // > 0
  double least_diameter_mm = 0;  // where the diameter itself has no room, > 0 and at most diameter_mm
  int least_count = 1;           // of the largest cavity; any other has one
};

// Where no hole is wanted: within radius_mm of the point.
struct KeepAway {
  Eigen::Vector3d point_mm = Eigen::Vector3d::Zero();
  double radius_mm = 0;
};

struct PlacedOpenings {
  std::vector<Opening> openings;
  // A hole narrower than the rule's diameter; a cavity with fewer holes than it asks for, and what would
  // help.
  std::vector<std::string> warnings;
};

inline constexpr double kRefusedInRadii = 0.4;
inline constexpr double kFlatCost = 1.0, kStressCost = 0.5, kNearCost = 1.0;
inline constexpr double kSteepestDegrees = 35.0;  // normals of M against the axis, over the rim and beyond

// closed_mesh: M, which the skin was built from; cavities: the closed pieces of M1. Holes in the base contact
// stay within its hull. No stress: not asked for. refused: openings that could not be made; none as wide or
// wider is placed within kRefusedInRadii of their radius. The same at any thread count.
PlacedOpenings place_openings(const TriangleMesh& closed_mesh, const Skin& skin, const Polygon2& contact_hull,
                              const StressMap* stress, const OpeningRule& rule,
                              const std::vector<TriangleMesh>& cavities,
                              const std::vector<KeepAway>& keep_away, const std::vector<Opening>& refused,
                              const RunContext& context);

}  // namespace skinframe
