// SPDX-License-Identifier: Apache-2.0
// SizeOpt of a frame as Ipopt takes it: over all areas and all displacements at once,
//
//   minimise    sum A_j l_j
//   subject to  sum_j A_j (G/l_j I + (E-G)/l_j n n^T)(d_b - d_a) on the ends of j = forces + weights    each
//   case
//               |d_i|^2 <= limit^2                                                                      each
//               node |n . (d_b - d_a)| <= (strength / E) l_j                              axial: linear, from
//               both sides
//               |(I - n n^T)(d_b - d_a)|^2 <= ((shear strength / G) l_j)^2 shear sum_j w l_j A_j (normal .
//               middle_j - offset) <= - the skin's moment                    each base edge least area <= A_j
//               <= most area
//
// with exact first and second derivatives. Strains that the displacement limit implies are left out unless
// asked for: |d_a|, |d_b| <= limit gives |d_b - d_a| <= 2 limit.
//
// Numbers are scaled: areas by the start's mean, displacements by the limit (or the start's largest).
#pragma once

#include <coin/IpTNLP.hpp>
#include <vector>

#include "tests/oracle/frame_file.h"

namespace oracle {

struct Start {
  std::vector<double> areas;
  std::vector<std::vector<Eigen::Vector3d>> displacements;  // one list a case
};

class SizeProgram : public Ipopt::TNLP {
 public:
  SizeProgram(const FrameFile& frame, const Start& start, bool every_strain);

  // After the solve; empty before.
  const std::vector<double>& areas() const { return areas_; }
  double volume() const;

  bool get_nlp_info(Ipopt::Index& n, Ipopt::Index& m, Ipopt::Index& jacobian, Ipopt::Index& hessian,
                    IndexStyleEnum& style) override;
  bool get_bounds_info(Ipopt::Index n, Ipopt::Number* xl, Ipopt::Number* xu, Ipopt::Index m,
                       Ipopt::Number* gl, Ipopt::Number* gu) override;
  bool get_starting_point(Ipopt::Index n, bool, Ipopt::Number* x, bool, Ipopt::Number*, Ipopt::Number*,
                          Ipopt::Index, bool, Ipopt::Number*) override;
  bool eval_f(Ipopt::Index n, const Ipopt::Number* x, bool, Ipopt::Number& f) override;
  bool eval_grad_f(Ipopt::Index n, const Ipopt::Number* x, bool, Ipopt::Number* gradient) override;
  bool eval_g(Ipopt::Index n, const Ipopt::Number* x, bool, Ipopt::Index m, Ipopt::Number* g) override;
  bool eval_jac_g(Ipopt::Index n, const Ipopt::Number* x, bool, Ipopt::Index m, Ipopt::Index entries,
                  Ipopt::Index* rows, Ipopt::Index* columns, Ipopt::Number* values) override;
  bool eval_h(Ipopt::Index n, const Ipopt::Number* x, bool, Ipopt::Number objective, Ipopt::Index m,
              const Ipopt::Number* lambda, bool, Ipopt::Index entries, Ipopt::Index* rows,
              Ipopt::Index* columns, Ipopt::Number* values) override;
  void finalize_solution(Ipopt::SolverReturn status, Ipopt::Index n, const Ipopt::Number* x,
                         const Ipopt::Number*, const Ipopt::Number*, Ipopt::Index m, const Ipopt::Number*,
                         const Ipopt::Number*, Ipopt::Number objective, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override;

 private:
  int strut_count() const { return static_cast<int>(frame_.struts.size()); }
  int case_count() const { return static_cast<int>(frame_.cases.size()); }
  int displacement(int load_case, int node, int axis) const;     // its variable, -1 where held
  int equilibrium_row(int load_case, int node, int axis) const;  // -1 where held
  Eigen::Vector3d moved(const Ipopt::Number* x, int load_case, int node) const;
  Eigen::Vector3d stretch(const Ipopt::Number* x, int load_case, const FrameStrut& strut) const;
  Eigen::Matrix3d stiffness(const FrameStrut& strut) const;  // of a unit area, scaled
  double half_weight(int load_case, const FrameStrut& strut) const;

  double axial_scale(const FrameStrut& strut) const;  // stretch over what the strength allows
  double shear_scale(const FrameStrut& strut) const;

  // Each nonzero of the Jacobian (of the Hessian's lower triangle) in a fixed order: emit(row, column,
  // value). The places do not depend on x, so one walk serves for the structure and for the values.
  template <class Emit>
  void walk_jacobian(const Ipopt::Number* x, const Emit& emit) const;
  template <class Emit>
  void walk_hessian(const Ipopt::Number* lambda, const Emit& emit) const;

  const FrameFile& frame_;
  const Start& start_;
  double area_unit_ = 1, displacement_unit_ = 1, length_unit_ = 1, force_unit_ = 1;
  std::vector<std::array<int, 3>> free_;  // of each node and axis: number among the free ones, -1 where held
  int free_count_ = 0;
  std::vector<int> limited_nodes_, axial_struts_, shear_struts_;
  int first_limit_ = 0, first_axial_ = 0, first_shear_ = 0, first_base_ = 0, rows_ = 0;
  std::vector<double> areas_;
};

}  // namespace oracle
