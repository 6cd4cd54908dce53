// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/strut_terms.h"

namespace skinframe {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

int case_at(int k) { return kCoordinatesPerCase * k; }

// The second derivative of l with respect to e.
Matrix3d length_hessian(const Vector3d& e) {
  const double l = e.norm();
  return Matrix3d::Identity() / l - e * e.transpose() / (l * l * l);
}

}  // namespace

StrutTermsOf::StrutTermsOf(const FrameProgram& program, const InequalityLayout& layout, const DenseRows& rows)
    : program_(program),
      layout_(layout),
      rows_(rows),
      cases_(program.case_count()),
      geometry_at_(case_at(program.case_count())),
      geometry_index_(program.strut_count(), -1),
      strains_of_(program.strut_count()) {
  for (std::size_t g = 0; g < layout.geometry_struts.size(); ++g)
    geometry_index_[layout.geometry_struts[g]] = static_cast<int>(g);
  for (std::size_t s = 0; s < program.strain_limits.size(); ++s)
    strains_of_[program.strain_limits[s].strut].push_back(static_cast<int>(s));
}

int StrutTermsOf::coordinates(int j) const { return geometry_at_ + (program_.strut_moves(j) ? 6 : 0); }

void StrutTermsOf::compute(int j, const Iterate& it, const VectorXd& pull, double regularisation,
                           StrutTerms& terms) const {
  const int size = coordinates(j);
  terms.hessian.setZero(size, size);
  terms.slope.setZero(size);
  terms.border.setZero(size, rows_.columns());
  terms.sums.setZero(rows_.sums());
  terms.elastic = 0;
  terms.curvature = regularisation + it.duals[layout_.area_lower + j] / it.slacks[layout_.area_lower + j] +
                    it.duals[layout_.area_upper + j] / it.slacks[layout_.area_upper + j];
  add_equilibrium(j, it, terms);
  add_strains(j, it, terms);
  add_sums(j, it, pull, terms);
  if (program_.strut_moves(j)) add_shape(j, it, terms);
}

void StrutTermsOf::add_equilibrium(int j, const Iterate& it, StrutTerms& terms) const {
  const auto [a, b] = program_.struts[j];
  const double area = it.point.areas[j];
  const Vector3d e = strut_vector(program_, it.point.positions, j);
  const bool moving = program_.strut_moves(j);
  const Matrix3d stiffness = strut_stiffness(program_.springs, e);
  for (int k = 0; k < cases_; ++k) {
    const int at = case_at(k);
    const double gravity = program_.cases[k].gravity;
    const StrutState q{e, it.point.displacements[k].col(b) - it.point.displacements[k].col(a),
                       it.point.multipliers[k].col(b) - it.point.multipliers[k].col(a),
                       gravity * (it.point.multipliers[k](2, a) + it.point.multipliers[k](2, b))};
    terms.slope.segment<3>(at) += stiffness * q.eta;
    terms.slope.segment<3>(at + 3) += stiffness * q.delta;
    terms.slope[at + 6] += gravity * program_.springs.half_weight * e.norm();
    terms.hessian.block<3, 3>(at, at + 3) += area * stiffness;
    terms.hessian.block<3, 3>(at + 3, at) += area * stiffness;
    if (!moving) continue;
    const int g = geometry_at_;
    terms.slope.segment<3>(g) += strut_work_gradient(program_.springs, q).head<3>();
    const StrutHessian h = area * strut_work_hessian(program_.springs, q);
    terms.hessian.block<3, 3>(g, g) += h.block<3, 3>(0, 0);
    terms.hessian.block<3, 6>(g, at) += h.block<3, 6>(0, 3);
    terms.hessian.block<6, 3>(at, g) += h.block<6, 3>(3, 0);
    terms.hessian.block<3, 1>(g, at + 6) += gravity * h.block<3, 1>(0, 9);
    terms.hessian.block<1, 3>(at + 6, g) += gravity * h.block<1, 3>(9, 0);
  }
}

void StrutTermsOf::add_strains(int j, const Iterate& it, StrutTerms& terms) const {
  const auto [a, b] = program_.struts[j];
  for (int k = 0; k < cases_; ++k)
    for (int s : strains_of_[j]) {
      const StrainLimit& limit = program_.strain_limits[s];
      const Vector3d e = strut_vector(program_, it.point.positions, j);
      const Vector3d delta = it.point.displacements[k].col(b) - it.point.displacements[k].col(a);
      const int at = case_at(k), i = layout_.strain_at(k, s), g = geometry_at_;
      const double sigma = it.duals[i] / it.slacks[i];
      const StrainGradient slope = squared_strain_gradient(limit.kind, e, delta) / limit.squared;
      const StrainHessian h = it.duals[i] / limit.squared * squared_strain_hessian(limit.kind, e, delta) +
                              sigma * slope * slope.transpose();
      const bool moving = program_.strut_moves(j);
      terms.hessian.block<3, 3>(at, at) += h.block<3, 3>(3, 3);
      if (moving) {
        terms.hessian.block<3, 3>(g, g) += h.block<3, 3>(0, 0);
        terms.hessian.block<3, 3>(g, at) += h.block<3, 3>(0, 3);
        terms.hessian.block<3, 3>(at, g) += h.block<3, 3>(3, 0);
      }
      if (!rows_.relaxed_limits()) continue;
      const int t = rows_.sums();
      terms.border.block<3, 1>(at, t) -= sigma * slope.tail<3>();
      if (moving) terms.border.block<3, 1>(g, t) -= sigma * slope.head<3>();
      terms.elastic += sigma;
    }
}

// The part of the Lagrangian that is A l (p + p_x x + p_y y) with the strut's middle (x, y), and the sums
// themselves.
void StrutTermsOf::add_sums(int j, const Iterate& it, const VectorXd& pull, StrutTerms& terms) const {
  const auto [a, b] = program_.struts[j];
  const Vector3d e = strut_vector(program_, it.point.positions, j);
  const Vector3d middle = (it.point.positions.col(a) + it.point.positions.col(b)) / 2;
  const double l = e.norm(), area = it.point.areas[j];
  for (int q = 0; q < rows_.sums(); ++q) terms.sums[q] = l * rows_.factor(q, middle);
  if (!program_.strut_moves(j)) return;

  const int g = geometry_at_;
  double weight = program_.volume_weight;
  Vector3d tilt = Vector3d::Zero();  // of the weight with the middle
  for (int q = 0; q < rows_.sums(); ++q) {
    weight += pull[q] * rows_.factor(q, middle);
    tilt += pull[q] * rows_.factor_gradient(q);
    terms.border.block<3, 1>(g, q) = area * rows_.factor(q, middle) / l * e;
    terms.border.block<3, 1>(g + 3, q) = area * l / 2 * rows_.factor_gradient(q);
  }
  const Matrix3d cross = area / (2 * l) * e * tilt.transpose();  // the middle is half of x_a + x_b
  terms.slope.segment<3>(g) += weight / l * e;
  terms.slope.segment<3>(g + 3) += l / 2 * tilt;
  terms.hessian.block<3, 3>(g, g) += weight * area * length_hessian(e);
  terms.hessian.block<3, 3>(g, g + 3) += cross;
  terms.hessian.block<3, 3>(g + 3, g) += cross.transpose();
}

// Slenderness and least length of a strut with a moving end.
void StrutTermsOf::add_shape(int j, const Iterate& it, StrutTerms& terms) const {
  const int g = geometry_at_, index = geometry_index_[j];
  const Vector3d e = strut_vector(program_, it.point.positions, j);
  if (program_.slenderness_area > 0 && !program_.area_is_given(j)) {
    const int i = layout_.slenderness + index;
    const double sigma = it.duals[i] / it.slacks[i];
    const Vector3d slope = 2 * program_.slenderness_area * e;  // and -1 in A
    terms.curvature += sigma;
    terms.slope.segment<3>(g) -= sigma * slope;
    terms.hessian.block<3, 3>(g, g) += sigma * slope * slope.transpose() +
                                       2 * it.duals[i] * program_.slenderness_area * Matrix3d::Identity();
  }
  if (program_.squared_min_length.size() > 0) {
    const int i = layout_.length + index;
    terms.hessian.block<3, 3>(g, g) +=
        4 * it.duals[i] / it.slacks[i] * e * e.transpose() - 2 * it.duals[i] * Matrix3d::Identity();
  }
}

void StrutTermsOf::coordinates_of(int j, const ProgramVector& step, VectorXd& q) const {
  const auto [a, b] = program_.struts[j];
  q.resize(coordinates(j));
  for (int k = 0; k < cases_; ++k) {
    q.segment<3>(case_at(k)) = step.displacements[k].col(b) - step.displacements[k].col(a);
    q.segment<3>(case_at(k) + 3) = step.multipliers[k].col(b) - step.multipliers[k].col(a);
    q[case_at(k) + 6] = step.multipliers[k](2, a) + step.multipliers[k](2, b);
  }
  if (program_.strut_moves(j)) {
    q.segment<3>(geometry_at_) = step.positions.col(b) - step.positions.col(a);
    q.segment<3>(geometry_at_ + 3) = step.positions.col(b) + step.positions.col(a);
  }
}

}  // namespace skinframe
