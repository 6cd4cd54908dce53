// SPDX-License-Identifier: GPL-3.0-or-later
// The elements of the valid model as an optimiser sees them: each one's part of the equilibrium Lagrangian
// lambda^T (K D - F), in the shape of mechanics/strut_element.h, with 6 freedoms a node.
//
//   W(z, d, lambda) = lambda^T (K(z) d - f(z)),    f: the element's own weight along -z, times `gravity`
//
// z: what a design can change. Of a strut the positions of its nodes, its arm (half the skin's thickness) and
// its radius; of a shell its corners and its thickness. Unlike the paper's, these elements are no multiple of
// the area, so that z holds the radius and W is the whole part. The optimiser's equilibrium row of the
// element is W's gradient in lambda, its Lagrangian's Hessian W's Hessian. Exact: forward differentiation of
// the formulas (jet.h). Units: mm, N, radians.
#pragma once

#include <Eigen/Core>

#include "worker/structure/structure.h"

namespace skinframe {

// Order: nodes' positions (0..5), arm (6), radius (7), d (8..19), lambda (20..31).
inline constexpr int kStrutArm = 6, kStrutRadius = 7, kStrutMotion = 8, kStrutMultiplier = 20;
using StrutWorkGradient = Eigen::Matrix<double, 32, 1>;
using StrutWorkHessian = Eigen::Matrix<double, 32, 32>;

struct StrutMotion {
  StrutVector d = StrutVector::Zero(), lambda = StrutVector::Zero();
  double gravity = 0;  // 1 where the load case has weight
};

struct ElementSetting {
  ElasticMaterial material;
  double weight_density_n_mm3 = 0;
};

double rigid_strut_work(const ElementSetting& setting, const RigidStrut& strut, const StrutMotion& motion);
StrutWorkGradient rigid_strut_work_gradient(const ElementSetting& setting, const RigidStrut& strut,
                                            const StrutMotion& motion);
StrutWorkHessian rigid_strut_work_hessian(const ElementSetting& setting, const RigidStrut& strut,
                                          const StrutMotion& motion);

// Order: thickness (0), d (1..18), lambda (19..36). Corners: below.
inline constexpr int kShellMotion = 1, kShellMultiplier = 19;
using ShellWorkGradient = Eigen::Matrix<double, 37, 1>;
using ShellWorkHessian = Eigen::Matrix<double, 37, 37>;

struct ShellMotion {
  ShellVector d = ShellVector::Zero(), lambda = ShellVector::Zero();
  double gravity = 0;
};

double shell_work(const ElementSetting& setting, const ShellTriangle& shell, const ShellMotion& motion);
ShellWorkGradient shell_work_gradient(const ElementSetting& setting, const ShellTriangle& shell,
                                      const ShellMotion& motion);
ShellWorkHessian shell_work_hessian(const ElementSetting& setting, const ShellTriangle& shell,
                                    const ShellMotion& motion);
// First derivatives in x y z of each corner in turn.
Eigen::Matrix<double, 9, 1> shell_work_d_position(const ElementSetting& setting, const ShellTriangle& shell,
                                                  const ShellMotion& motion);

// The same of a whole structure, summed where elements share a variable.
struct DesignGradient {
  Eigen::VectorXd radius;        // one a strut
  Eigen::VectorXd arm;           // one a strut
  Eigen::VectorXd thickness;     // one a shell
  Eigen::Matrix3Xd position_mm;  // one a node
};

// d/dz of lambda^T (K D - F) at given D and lambda, F being self weight times `gravity` and what does not
// depend on the design. With lambda = -K^-1 dJ/dD it is the whole derivative of a response J(D).
DesignGradient work_gradient(const Structure& structure, const Eigen::VectorXd& d,
                             const Eigen::VectorXd& lambda, double gravity);

}  // namespace skinframe
