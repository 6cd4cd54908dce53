// SPDX-License-Identifier: GPL-3.0-or-later
// The nonlinear program behind SizeOpt, TopOpt and GeoOpt, in nondimensional numbers (see program_scale.h):
//
//   minimise    volume_weight sum A_j l_j  +  sum area_weights_j A_j  +  elastic_weight t
//   over        areas A, positions x of the nodes that move, displacements D of each load case, and t
//   subject to  K(x) A D = F(A, x) for each case                                   (1)    equalities,
//   multipliers lambda
//               lower <= A <= upper                                                (9,10) and (4,5) where
//               nothing moves |d_i|^2 <= limit^2 [or t]      each node, each case                (6)
//               strain_j^2 <= limit^2 [or t]   each strut listed, each case        (2,3)
//               kappa l_j^2 <= A_j             each strut with a moving end        (4,5)
//               l_j^2 >= min_length_j^2        the same
//               normal . x_i <= offset         each half-space listed              (7)
//               moment about each edge of the base hull <= 0 [or t]                (8)    dense rows
//               sum A_j l_j <= cap                                                 (20)   dense row
//
// Inequalities are written c <= 0 and stand in one flat vector; Layout says where. All but the dense rows
// couple only the ends of a strut or the axes of a node. With A as the variable everything is linear in A,
// and only (1) is bilinear.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "worker/mechanics/strut_element.h"
#include "worker/mechanics/strut_strain.h"

namespace skinframe {

using NodeMatrix = Eigen::Matrix3Xd;  // one column a node

// A point of the program, a direction in it, or a gradient with respect to it. Multipliers ride along.
struct ProgramVector {
  Eigen::VectorXd areas;
  NodeMatrix positions;  // of all nodes; directions and gradients are zero where a node does not move
  std::vector<NodeMatrix> displacements;  // one a load case; zero at fixed axes
  std::vector<NodeMatrix> multipliers;    // the same
  double elastic = 0;                     // t

  void add(double step, const ProgramVector& direction);  // this += step * direction
};

struct ProgramCase {
  NodeMatrix force;    // external and skin weight
  double gravity = 0;  // 1: the struts' own weight acts
};

struct StrainLimit {
  int strut = 0;
  StrainKind kind = StrainKind::kAxial;
  double squared = 1;
};

struct NodeHalfSpace {
  int node = 0;
  Eigen::Vector3d normal;
  double offset = 0;
};

// scale * (sum A_j l_j (normal . mid_j - offset) + skin_moment) <= 0
struct BalanceRow {
  Eigen::Vector3d normal;  // z = 0
  double offset = 0, skin_moment = 0, scale = 1;
};

enum class ElasticScope { kNone, kLimits, kBalance };  // which inequalities t relaxes

struct FrameProgram {
  std::vector<std::pair<int, int>> struts;
  std::vector<std::array<bool, 3>> fixed;  // one a node
  std::vector<bool> moves;                 // one a node
  StrutSprings springs;
  std::vector<ProgramCase> cases;
  Eigen::VectorXd lower, upper;  // equal: the area is given and does not change
  double volume_weight = 1;
  Eigen::VectorXd area_weights;  // empty: none
  double elastic_weight = 0;
  ElasticScope elastic = ElasticScope::kNone;
  std::optional<double> squared_displacement_limit;
  std::vector<StrainLimit> strain_limits;  // by strut
  double slenderness_area = 0;             // kappa = pi / alpha^2; 0: none. Of struts with a moving end only.
  Eigen::VectorXd squared_min_length;      // one a strut, or empty
  std::vector<NodeHalfSpace> half_spaces;
  std::vector<BalanceRow> balance;
  std::optional<double> volume_cap;
  double cap_scale = 100;  // the row reads cap_scale (V / cap - 1) <= 0

  int node_count() const { return static_cast<int>(fixed.size()); }
  int strut_count() const { return static_cast<int>(struts.size()); }
  int case_count() const { return static_cast<int>(cases.size()); }
  bool strut_moves(int j) const { return moves[struts[j].first] || moves[struts[j].second]; }
  bool area_is_given(int j) const { return !(lower[j] < upper[j]); }
};

// Where each family of inequalities stands in the flat vector.
struct InequalityLayout {
  explicit InequalityLayout(const FrameProgram& program);
  int area_lower = 0, area_upper = 0, displacement = 0, strain = 0, slenderness = 0, length = 0,
      half_space = 0, rows = 0;
  int count = 0;
  int row_count = 0;                 // the dense rows: balance, then the cap
  int strain_count = 0;              // strain limits of one case
  std::vector<int> geometry_struts;  // struts with a moving end: the order of `slenderness` and `length`
  int displacement_at(int load_case, int node, int nodes) const {
    return displacement + load_case * nodes + node;
  }
  int strain_at(int load_case, int limit) const { return strain + load_case * strain_count + limit; }
};

Eigen::Vector3d strut_vector(const FrameProgram& program, const NodeMatrix& positions, int strut);
double program_volume(const FrameProgram& program, const ProgramVector& point);
double objective(const FrameProgram& program, const ProgramVector& point);

// K D - F of each case; zero at fixed axes.
std::vector<NodeMatrix> equilibrium_residuals(const FrameProgram& program, const ProgramVector& point);

// c at the point. A relation that cannot bind (a given area, a node that is fixed) reads -1.
Eigen::VectorXd inequalities(const FrameProgram& program, const InequalityLayout& layout,
                             const ProgramVector& point);

// The gradient of objective + lambda^T (K D - F) + weights^T c. Its multiplier part is K D - F.
ProgramVector lagrangian_gradient(const FrameProgram& program, const InequalityLayout& layout,
                                  const ProgramVector& point, const Eigen::VectorXd& weights);

// The derivative of c along a direction.
Eigen::VectorXd inequality_slopes(const FrameProgram& program, const InequalityLayout& layout,
                                  const ProgramVector& point, const ProgramVector& direction);
double objective_slope(const FrameProgram& program, const ProgramVector& point,
                       const ProgramVector& direction);

}  // namespace skinframe
