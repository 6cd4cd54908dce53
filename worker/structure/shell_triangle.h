// SPDX-License-Identifier: GPL-3.0-or-later
// A flat triangle of thin shell, 6 degrees of freedom a node: Felippa's OPT membrane with drilling
// (membrane.h) and discrete Kirchhoff bending (plate.h), on the mid-surface.
//
//   K = t K_m + t^3 / 12 K_b
//
// Order of freedoms: u_x u_y u_z theta_x theta_y theta_z of each corner, in global axes, mm and radians.
// The value and its derivatives are functions of the same arguments. Positions: x y z of each corner in turn.
#pragma once

#include <Eigen/Core>
#include <array>

#include "worker/stress/elasticity.h"

namespace skinframe {

using ShellMatrix = Eigen::Matrix<double, 18, 18>;
using ShellVector = Eigen::Matrix<double, 18, 1>;

struct ShellTriangle {
  std::array<Eigen::Vector3d, 3> corner_mm{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
                                           Eigen::Vector3d::Zero()};
  double thickness_mm = 0;
};

ShellMatrix shell_stiffness(const ShellTriangle& shell, const ElasticMaterial& material);
ShellMatrix shell_stiffness_d_thickness(const ShellTriangle& shell, const ElasticMaterial& material);
ShellMatrix shell_stiffness_d2_thickness(const ShellTriangle& shell, const ElasticMaterial& material);
std::array<ShellMatrix, 9> shell_stiffness_d_position(const ShellTriangle& shell,
                                                      const ElasticMaterial& material);

double shell_area_mm2(const ShellTriangle& shell);

// At the triangle's middle: the membrane's own stress, and what bending adds on the side that the normal
// (counter-clockwise corners) points to. Local axes: x along the first side.
struct ShellStress {
  Eigen::Vector3d membrane_mpa = Eigen::Vector3d::Zero();  // xx yy xy
  Eigen::Vector3d bending_mpa = Eigen::Vector3d::Zero();
  double von_mises_mpa = 0;  // the larger of both surfaces
};
ShellStress shell_stress(const ShellTriangle& shell, const ElasticMaterial& material,
                         const ShellVector& displacement);

// What membrane stress adds to the stiffness (tension stiffens), for buckling: with linear displacements.
ShellMatrix shell_geometric_stiffness(const ShellTriangle& shell, const Eigen::Vector3d& membrane_mpa);

}  // namespace skinframe
