// SPDX-License-Identifier: GPL-3.0-or-later
// Where a body touches the plate, and whether it stands there (constraint (8)
// of the paper: the centre of gravity projects into the convex hull of the base contact).
// Units: mm.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "worker/mesh/triangle_mesh.h"
#include "worker/solid/solid.h"

namespace skinframe {

// Absolute: surface within this height of the lowest point counts as touching.
inline constexpr double kContactToleranceMm = 1.0;

using Polygon2 = std::vector<Eigen::Vector2d>;

// The convex hull, in xy, of the surface with z <= z_min + tolerance_mm. Triangles are clipped at that
// height, so a large triangle counts with its low part only. Counter-clockwise, no repeated point, no three
// points in line; one or two points when the contact has no extent. Empty only for an empty mesh.
Polygon2 contact_hull(const TriangleMesh& mesh, double tolerance_mm = kContactToleranceMm);

// Convex hull (monotone chain): counter-clockwise, without collinear points.
Polygon2 convex_hull(std::vector<Eigen::Vector2d> points);

// A convex polygon inside `hull` with at most max_corners (>= 3) of its corners: again and again the corner
// that cuts off the least area goes. Of a circle's hull, 24 corners leave out less than 1 % of the radius.
Polygon2 inscribed_polygon(Polygon2 hull, int max_corners);

// Distance of `point` to the boundary of a convex counter-clockwise polygon: positive inside, negative
// outside. A polygon of one or two points has no inside: minus the distance to it.
double signed_margin_mm(const Polygon2& hull, const Eigen::Vector2d& point);

struct Contact {
  Polygon2 hull;
  double plane_z_mm = 0;  // the lowest z
  double margin_mm = 0;   // of the solid's centroid; positive inside
  bool stands = false;    // margin_mm > 0
};

Contact find_contact(const Solid& solid, double tolerance_mm = kContactToleranceMm);

}  // namespace skinframe
