// SPDX-License-Identifier: GPL-3.0-or-later
// The body that supports stand in, as questions: how deep is a point, which way is out. A skin answers them
// in a job, a formula in a test. Units: mm, z up.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>

#include "worker/support/support_plan.h"

namespace skinframe {

struct Skin;
class TriangleTree;

struct PrintedBody {
  std::function<double(const Eigen::Vector3d&)> depth_mm;          // below the surface of M, negative outside
  std::function<Eigen::Vector3d(const Eigen::Vector3d&)> outward;  // of the nearest wall; unit, or shorter
                                                                   // where that is not unique
  double skin_thickness_mm = 1;
  double plate_z_mm = 0;
  double step_mm = 0.5;  // of walks along a line
  // From a point to the nearest one of M's surface: what tells how steep the wall there is. Set: exact, while
  // the two above are of a distance field; not set: as far along `outward` as the point is deep.
  std::function<Eigen::Vector3d(const Eigen::Vector3d&)> to_surface_mm = {};
};

// The skin must outlive it, and the surface of M where it is given.
PrintedBody body_of(const Skin& skin);
PrintedBody body_of(const Skin& skin, const TriangleTree& surface);

// Where an upright line from a point downwards first meets something to stand on.
struct Footing {
  Eigen::Vector3d at_mm = Eigen::Vector3d::Zero();
  SupportKind kind = SupportKind::kInternal;
  bool on_plate = false;  // else on the skin
};
// None: the material below the point does not end for kSolidBelowInSkins, so it is held already.
std::optional<Footing> footing_below(const PrintedBody& body, const Eigen::Vector3d& point);
inline constexpr double kSolidBelowInSkins = 4.0;

// A straight strut between two points stays within M, or outside of it but for its ends; none: it would pass
// through the skin. About each end kEndInSkins is not looked at: nodes stand in the skin.
std::optional<SupportKind> side_of_segment(const PrintedBody& body, const Eigen::Vector3d& upper,
                                           const Eigen::Vector3d& lower);
inline constexpr double kEndInSkins = 2.0;

// The point stands within M, in or at a wall that is no flatter than the angle from the vertical: the wall
// holds itself and what is in it.
bool is_in_steep_wall(const PrintedBody& body, const Eigen::Vector3d& point, double angle_rad);

}  // namespace skinframe
