// SPDX-License-Identifier: GPL-3.0-or-later
// A drain hole: a cylinder through the skin, and what has to stay out of it. Units: mm.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "worker/skin/build_skin.h"

namespace skinframe {

// The cylinder of radius_mm about the axis, from rise_mm outside of the centre to clear_mm inside of it. Its
// outer end is outside of M all over, its inner end in the cavity, and no strut comes into it.
struct Opening {
  Eigen::Vector3d centre_mm = Eigen::Vector3d::Zero();  // on M
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();      // unit, outwards
  double radius_mm = 0;
  double rise_mm = 0;
  double clear_mm = 0;
};

// Two unit vectors across the axis; with it they turn counter-clockwise seen from outside.
struct Across {
  Eigen::Vector3d u, v;
};
Across across(const Opening& opening);

// Distance of the point to the cylinder, 0 within.
double distance_mm(const Opening& opening, const Eigen::Vector3d& point_mm);
// Of the segment a-b, by its points a quarter of a millimetre apart at most: too large by less than that.
double distance_mm(const Opening& opening, const Eigen::Vector3d& a, const Eigen::Vector3d& b);
// Of the nearest of several; infinite where there is none.
double distance_mm(const std::vector<Opening>& openings, const Eigen::Vector3d& a, const Eigen::Vector3d& b);

// The largest radius of a strut from a to b beside the openings. It keeps kStrutSlackMm off: a strut that
// touches the cylinder stands within it in places once it is a mesh, and nothing can be cut there.
inline constexpr double kStrutSlackMm = 0.2;
double room_mm(const std::vector<Opening>& openings, const Eigen::Vector3d& a, const Eigen::Vector3d& b);

// How far from the axis the rim's nodes stand: their chords, with struts of the skin's largest radius h_S
// along them, stay kRimSlackMm clear of the opening.
inline constexpr int kRimNodes = 12;
inline constexpr double kRimSlackMm = 0.2;
double rim_radius_mm(const Opening& opening, double skin_thickness_mm);

// Along the axis from the centre, where a line at that place across the axis meets the surface at `depth`
// below M, negative inwards; none where it does not within the cylinder's length.
struct SurfaceHit {
  bool found = false;
  double along_mm = 0;
};
SurfaceHit meet_surface(const Opening& opening, const Eigen::Vector2d& offset_mm, double depth_mm,
                        const Skin& skin);

// The rim on M1 as a closed curve, counter-clockwise seen from outside; its kRimNodes corners are nodes of
// the skin. Empty where M1 is not all about the opening.
SharpCurve rim_curve(const Opening& opening, const Skin& skin);

}  // namespace skinframe
