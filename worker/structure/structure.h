// SPDX-License-Identifier: GPL-3.0-or-later
// The valid model of a skin-frame, beside the paper's: skin as thin shell, struts as Timoshenko beams, joints
// rigid, 6 degrees of freedom a node (shell_triangle.h, rigid_strut.h). What a result is verified with.
// Units: mm, N, MPa, radians.
//
// Invariants, checked by validate():
//  1. Nodes of shells and struts are in range; no shell without area, no strut without length.
//  2. Thicknesses, radii and the modulus are positive; Poisson's ratio lies in [0, 0.49]; all is finite.
//  3. held has one entry a node.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "worker/run/result.h"
#include "worker/structure/rigid_strut.h"
#include "worker/structure/shell_triangle.h"

namespace skinframe {

struct StructureShell {
  std::array<int, 3> nodes{};  // counter-clockwise seen from outside
  double thickness_mm = 0;
};

struct StructureStrut {
  std::array<int, 2> nodes{};
  StrutShape shape = StrutShape::kFullDisc;
  std::array<Eigen::Vector3d, 2> arm{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};  // see RigidStrut
  double arm_mm = 0;
  double radius_mm = 0;
  int origin = -1;  // the strut of the frame that this is a part of; for the caller
};

using HeldFreedoms = std::array<bool, 6>;
inline constexpr HeldFreedoms kFree = {false, false, false, false, false, false};
inline constexpr HeldFreedoms kClamped = {true, true, true, true, true, true};

struct Structure {
  ElasticMaterial material;
  double weight_density_n_mm3 = 0;
  std::vector<Eigen::Vector3d> nodes_mm;  // of the mid-surface, and inside
  std::vector<StructureShell> shells;
  std::vector<StructureStrut> struts;
  std::vector<HeldFreedoms> held;

  ShellTriangle shell(std::size_t i) const;
  RigidStrut strut(std::size_t j) const;
};

// Ok, or the first invariant that does not hold, naming the element.
Status validate(const Structure& structure);

// One column a load case, six rows a node.
using NodalColumns = Eigen::MatrixXd;

// Consistent nodal forces of the weight of skin and struts along -z.
Eigen::VectorXd self_weight_n(const Structure& structure);
// Nominal: skin and struts counted in full, half discs as half discs.
double structure_volume_mm3(const Structure& structure);

// The element's freedoms out of a column.
ShellVector freedoms_of(const StructureShell& shell, const Eigen::Ref<const Eigen::VectorXd>& column);
StrutVector freedoms_of(const StructureStrut& strut, const Eigen::Ref<const Eigen::VectorXd>& column);

}  // namespace skinframe
