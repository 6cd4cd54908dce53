// SPDX-License-Identifier: GPL-3.0-or-later
// A strut that is rigidly joined at its ends: Timoshenko's beam with 6 degrees of freedom a node. Unlike the
// paper's springs it is invariant under rotation. "Rigid" is the joint, not the strut.
//
// Order of freedoms: u_x u_y u_z theta_x theta_y theta_z of node a, then of b, in global axes, mm and
// radians. The axis may stand off its nodes by rigid arms: end = node + arm_i (arm_mm + c r), c = 4 / (3 pi)
// for the half disc and 0 for the full one. arm_i: a unit vector, or zero where the axis meets the node
// itself.
//
//   K = O^T R^T k R O,  k: 12 x 12 of the straight beam (Przemieniecki, Theory of Matrix Structural Analysis,
//   5.6, with shear), R: turns into the strut's axes, O: carries the node's motion along the arm.
//
// The value and its derivatives are functions of the same arguments. Positions: x y z of a, then of b; arms
// keep their direction.
#pragma once

#include <Eigen/Core>
#include <array>

#include "worker/stress/elasticity.h"
#include "worker/structure/strut_section.h"

namespace skinframe {

using StrutMatrix = Eigen::Matrix<double, 12, 12>;
using StrutVector = Eigen::Matrix<double, 12, 1>;

struct RigidStrut {
  StrutShape shape = StrutShape::kFullDisc;
  std::array<Eigen::Vector3d, 2> node_mm{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  std::array<Eigen::Vector3d, 2> arm{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  double arm_mm = 0;  // half the skin's thickness, where there is skin
  double radius_mm = 0;
};

StrutMatrix rigid_strut_stiffness(const RigidStrut& strut, const ElasticMaterial& material);
StrutMatrix rigid_strut_stiffness_d_radius(const RigidStrut& strut, const ElasticMaterial& material);
StrutMatrix rigid_strut_stiffness_d2_radius(const RigidStrut& strut, const ElasticMaterial& material);
StrutMatrix rigid_strut_stiffness_d_arm(const RigidStrut& strut, const ElasticMaterial& material);
std::array<StrutMatrix, 6> rigid_strut_stiffness_d_position(const RigidStrut& strut,
                                                            const ElasticMaterial& material);

double rigid_strut_length_mm(const RigidStrut& strut);  // of the axis, arms in place

// Consistent nodal forces and moments of the strut's weight along -z, N and N mm.
StrutVector rigid_strut_weight(const RigidStrut& strut, const ElasticMaterial& material,
                               double weight_density_n_mm3);

struct StrutStress {
  double axial_force_n = 0;  // tension positive
  double von_mises_mpa =
      0;  // worst end: |axial| + |bending| of the extreme fibre, with torsion and the largest
          // transverse shear, as if they met in one point: never too low for these forces
};
StrutStress rigid_strut_stress(const RigidStrut& strut, const ElasticMaterial& material,
                               const StrutVector& displacement);

// What an axial force adds to the stiffness (tension stiffens), for buckling: the consistent geometric matrix
// of a cubic beam (Przemieniecki, 15.4).
StrutMatrix rigid_strut_geometric_stiffness(const RigidStrut& strut, double axial_force_n);

}  // namespace skinframe
