// SPDX-License-Identifier: GPL-3.0-or-later
// Cross sections of struts: the full disc of internal struts, and of skin struts the half disc that stands
// below the skin (the other half lies in the skin and is counted there).
//
//   full disc  A = pi r^2    I = pi r^4 / 4                                     J = pi r^4 / 2
//   half disc  A = pi r^2/2  I_out = (pi/8 - 8/(9 pi)) r^4  I_in = pi r^4 / 8   J = 0.298 r^4
//
// I_out resists bending in the plane that holds the skin's normal, I_in bending in the skin's plane. The half
// disc's centroid lies 4 r / (3 pi) below its flat side. Shear coefficients: 6 (1 + nu) / (7 + 6 nu) for the
// disc (Cowper, J. Appl. Mech. 33, 1966), 0.85 for the half disc; its J is that of the semicircle by series
// (Timoshenko and Goodier, Theory of Elasticity, section 109).
#pragma once

#include <numbers>

namespace skinframe {

enum class StrutShape { kFullDisc, kHalfDisc };

template <class T>
struct StrutSection {
  T area, i_out, i_in, torsion;  // mm2, mm4
  double shear_coefficient = 0;
};

inline constexpr double kHalfDiscCentroid = 4 / (3 * std::numbers::pi);  // in radii, below the flat side

template <class T>
StrutSection<T> section_of(StrutShape shape, const T& radius_mm, double poisson_ratio) {
  constexpr double pi = std::numbers::pi;
  const T r2 = radius_mm * radius_mm, r4 = r2 * r2;
  if (shape == StrutShape::kFullDisc)
    return {T(pi) * r2, T(pi / 4) * r4, T(pi / 4) * r4, T(pi / 2) * r4,
            6 * (1 + poisson_ratio) / (7 + 6 * poisson_ratio)};
  return {T(pi / 2) * r2, T(pi / 8 - 8 / (9 * pi)) * r4, T(pi / 8) * r4, T(0.298) * r4, 0.85};
}

}  // namespace skinframe
