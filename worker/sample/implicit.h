// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies as functions of space: negative inside, zero on the surface, near the surface about the distance to
// it (mm). Formulas: Hart 1996 (sphere tracing), Quilez (distance functions). Internal to the room.
#pragma once

#include <Eigen/Core>
#include <functional>

namespace skinframe {

using Point = Eigen::Vector3d;
using Implicit = std::function<double(const Point&)>;

Implicit sphere(const Point& centre, double radius);
Implicit capsule(const Point& a, const Point& b, double radius);
// Axis along z through (x, y), from z_low to z_high, its edges rounded by `rounding`.
Implicit upright_cylinder(const Eigen::Vector2d& axis, double radius, double z_low, double z_high,
                          double rounding);
Implicit rounded_box(const Point& low, const Point& high, double rounding);
// Axis of symmetry along y.
Implicit upright_torus(const Point& centre, double ring_radius, double tube_radius);
Implicit ellipsoid(const Point& centre, const Point& semi_axes);

// The union, its creases filled with a fillet of about `fillet` (0: sharp).
Implicit join(Implicit a, Implicit b, double fillet);
Implicit cut(Implicit body, Implicit tool);  // body without tool
Implicit stand_on_plate(Implicit body);      // what of the body lies above z = 0

}  // namespace skinframe
