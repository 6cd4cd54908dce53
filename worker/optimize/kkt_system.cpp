// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/kkt_system.h"

#include <Eigen/Dense>

namespace skinframe {
namespace {

using Eigen::Infinity;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kRefinements = 2;
constexpr double kRefinedEnough = 1e-11;

// Strut coordinates of load case k: delta 0..2, eta 3..5, s 6. The geometry stands after the last case.
constexpr int kPerCase = 7;
int case_at(int k) { return kPerCase * k; }

std::vector<int> node_block_rows(const FrameProgram& program) {
  std::vector<int> rows(program.node_count());
  for (int i = 0; i < program.node_count(); ++i)
    rows[i] = 6 * program.case_count() + (program.moves[i] ? 3 : 0);
  return rows;
}

// The second derivative of l with respect to e.
Matrix3d length_hessian(const Vector3d& e) {
  const double l = e.norm();
  return Matrix3d::Identity() / l - e * e.transpose() / (l * l * l);
}

// What takes the place of the duals when slacks and duals are condensed: mu / s + Sigma (c + s); z for the
// dense rows.
VectorXd condensed_duals(const FrameProgram& program, const InequalityLayout& layout, const Iterate& it,
                         double barrier) {
  const VectorXd c = inequalities(program, layout, it.point);
  VectorXd pulls = (barrier + it.duals.array() * (c + it.slacks).array()) / it.slacks.array();
  pulls.tail(layout.row_count) = it.duals.tail(layout.row_count);
  return pulls;
}

}  // namespace

KktSystem::KktSystem(const FrameProgram& program, const InequalityLayout& layout)
    : program_(program),
      layout_(layout),
      axes_(program.node_count()),
      geometry_index_(program.strut_count(), -1),
      strains_of_(program.strut_count()),
      matrix_(node_block_rows(program), program.struts),
      cases_(program.case_count()),
      geometry_at_(case_at(program.case_count())),
      has_elastic_(program.elastic != ElasticScope::kNone),
      slopes_(program.strut_count()),
      curvatures_(program.strut_count()),
      row_areas_(layout.row_count, program.strut_count()) {
  for (int i = 0; i < program.node_count(); ++i) {
    for (int k = 0; k < cases_; ++k)
      for (int axis = 0; axis < 3; ++axis) {
        if (program.fixed[i][axis]) continue;
        axes_[i].push_back({3 * k + axis, case_at(k) + axis, -1});
        axes_[i].push_back({3 * (cases_ + k) + axis, case_at(k) + 3 + axis, axis == 2 ? case_at(k) + 6 : -1});
      }
    for (int axis = 0; program.moves[i] && axis < 3; ++axis)
      axes_[i].push_back({6 * cases_ + axis, geometry_at_ + axis, geometry_at_ + 3 + axis});
    wanted_.positive += 3 * cases_ + (program.moves[i] ? 3 : 0);
    wanted_.negative += 3 * cases_;
  }
  for (std::size_t g = 0; g < layout.geometry_struts.size(); ++g)
    geometry_index_[layout.geometry_struts[g]] = static_cast<int>(g);
  for (std::size_t s = 0; s < program.strain_limits.size(); ++s)
    strains_of_[program.strain_limits[s].strut].push_back(static_cast<int>(s));
}

int KktSystem::coordinates(int j) const { return geometry_at_ + (program_.strut_moves(j) ? 6 : 0); }

void KktSystem::assemble(const Iterate& it, double barrier, const Regularisation& regularisation) {
  const int borders = layout_.row_count + (has_elastic_ ? 1 : 0);
  const ProgramVector gradient =
      lagrangian_gradient(program_, layout_, it.point, condensed_duals(program_, layout_, it, barrier));
  matrix_.set_zero();
  right_hand_side_ = VectorXd::Zero(matrix_.rows());
  border_ = MatrixXd::Zero(matrix_.rows(), borders);
  corner_ = MatrixXd::Zero(borders, borders);
  border_right_ = VectorXd::Zero(borders);
  area_gradient_ = gradient.areas;

  const VectorXd c = inequalities(program_, layout_, it.point);
  for (int r = 0; r < layout_.row_count; ++r) {
    const int i = layout_.rows + r;
    corner_(r, r) = -it.slacks[i] / it.duals[i];
    border_right_[r] = -c[i] - barrier / it.duals[i];
  }
  if (has_elastic_) {
    const int t = borders - 1;
    corner_(t, t) = regularisation.primal;
    border_right_[t] = -gradient.elastic;
    if (program_.elastic == ElasticScope::kBalance)
      for (std::size_t r = 0; r < program_.balance.size(); ++r) corner_(t, r) = corner_(r, t) = -1;
  }

  double volume_weight = program_.volume_weight;
  if (program_.volume_cap)
    volume_weight += it.duals[layout_.count - 1] * program_.cap_scale / *program_.volume_cap;
  StrutTerms& terms = scratch_;
  for (int j = 0; j < program_.strut_count(); ++j) {
    terms.hessian.setZero(coordinates(j), coordinates(j));
    terms.slope.setZero(coordinates(j));
    terms.border.setZero(coordinates(j), borders);
    terms.row_area.setZero(layout_.row_count);
    terms.curvature = regularisation.primal +
                      it.duals[layout_.area_lower + j] / it.slacks[layout_.area_lower + j] +
                      it.duals[layout_.area_upper + j] / it.slacks[layout_.area_upper + j];
    add_equilibrium(j, it, terms);
    add_strains(j, it, terms);
    if (program_.strut_moves(j)) {
      add_volume(j, volume_weight, it, terms);
      add_geometry(j, it, terms);
    }
    if (layout_.row_count > 0) add_rows(j, it, terms);
    eliminate_area(j, gradient, terms);
  }
  add_nodes(it, gradient, regularisation);
}

void KktSystem::add_equilibrium(int j, const Iterate& it, StrutTerms& terms) const {
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

void KktSystem::add_volume(int j, double weight, const Iterate& it, StrutTerms& terms) const {
  const Vector3d e = strut_vector(program_, it.point.positions, j);
  terms.slope.segment<3>(geometry_at_) += weight / e.norm() * e;
  terms.hessian.block<3, 3>(geometry_at_, geometry_at_) += weight * it.point.areas[j] * length_hessian(e);
}

void KktSystem::add_strains(int j, const Iterate& it, StrutTerms& terms) {
  const auto [a, b] = program_.struts[j];
  for (int k = 0; k < cases_; ++k)
    for (int s : strains_of_[j]) {
      const StrainLimit& limit = program_.strain_limits[s];
      const Vector3d e = strut_vector(program_, it.point.positions, j);
      const Vector3d delta = it.point.displacements[k].col(b) - it.point.displacements[k].col(a);
      const int at = case_at(k), i = layout_.strain_at(k, s);
      const double sigma = it.duals[i] / it.slacks[i];
      const StrainGradient slope = squared_strain_gradient(limit.kind, e, delta) / limit.squared;
      const StrainHessian h = it.duals[i] / limit.squared * squared_strain_hessian(limit.kind, e, delta) +
                              sigma * slope * slope.transpose();
      terms.hessian.block<3, 3>(at, at) += h.block<3, 3>(3, 3);
      if (program_.strut_moves(j)) {
        terms.hessian.block<3, 3>(geometry_at_, geometry_at_) += h.block<3, 3>(0, 0);
        terms.hessian.block<3, 3>(geometry_at_, at) += h.block<3, 3>(0, 3);
        terms.hessian.block<3, 3>(at, geometry_at_) += h.block<3, 3>(3, 0);
      }
      if (program_.elastic != ElasticScope::kLimits) continue;
      const int t = layout_.row_count;
      terms.border.block<3, 1>(at, t) -= sigma * slope.tail<3>();
      if (program_.strut_moves(j)) terms.border.block<3, 1>(geometry_at_, t) -= sigma * slope.head<3>();
      corner_(t, t) += sigma;
    }
}

void KktSystem::add_geometry(int j, const Iterate& it, StrutTerms& terms) const {
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

void KktSystem::add_rows(int j, const Iterate& it, StrutTerms& terms) const {
  const auto [a, b] = program_.struts[j];
  const int g = geometry_at_;
  const double area = it.point.areas[j];
  const Vector3d e = strut_vector(program_, it.point.positions, j);
  const double l = e.norm();
  const bool moving = program_.strut_moves(j);
  int r = 0;
  for (const BalanceRow& row : program_.balance) {
    const double weight = it.duals[layout_.rows + r];
    const double arm = row.normal.dot(it.point.positions.col(a) + it.point.positions.col(b)) / 2 - row.offset;
    const Vector3d half = row.normal / 2;  // the middle is half of x_a + x_b
    terms.row_area[r] = row.scale * l * arm;
    if (moving) {
      terms.border.block<3, 1>(g, r) = row.scale * area * arm / l * e;
      terms.border.block<3, 1>(g + 3, r) = row.scale * area * l * half;
      terms.slope.segment<3>(g) += weight * row.scale * arm / l * e;
      terms.slope.segment<3>(g + 3) += weight * row.scale * l * half;
      const Matrix3d cross = weight * row.scale * area / l * e * half.transpose();
      terms.hessian.block<3, 3>(g, g) += weight * row.scale * area * arm * length_hessian(e);
      terms.hessian.block<3, 3>(g, g + 3) += cross;
      terms.hessian.block<3, 3>(g + 3, g) += cross.transpose();
    }
    ++r;
  }
  if (program_.volume_cap) {
    const double scale = program_.cap_scale / *program_.volume_cap;
    terms.row_area[r] = scale * l;
    if (moving) terms.border.block<3, 1>(g, r) = scale * area / l * e;
  }
}

void KktSystem::eliminate_area(int j, const ProgramVector& gradient, StrutTerms& terms) {
  slopes_[j] = terms.slope;
  curvatures_[j] = terms.curvature;
  row_areas_.col(j) = terms.row_area;
  VectorXd moved = VectorXd::Zero(terms.slope.size());
  if (!program_.area_is_given(j)) {
    const double inverse = 1 / terms.curvature;
    terms.hessian.noalias() -= inverse * terms.slope * terms.slope.transpose();
    moved = inverse * gradient.areas[j] * terms.slope;
    const int rows = layout_.row_count;
    if (rows > 0) {
      terms.border.leftCols(rows).noalias() -= inverse * terms.slope * terms.row_area.transpose();
      corner_.topLeftCorner(rows, rows).noalias() -= inverse * terms.row_area * terms.row_area.transpose();
      border_right_.head(rows) += inverse * gradient.areas[j] * terms.row_area;
    }
  }
  scatter(j, terms, moved);
}

void KktSystem::scatter(int j, const StrutTerms& terms, const VectorXd& right_hand_side) {
  const int ends[2] = {program_.struts[j].first, program_.struts[j].second};
  const MatrixXd& h = terms.hessian;
  const auto entry = [&h](const Axis& r, double row_sign, const Axis& c, double column_sign) {
    double value = row_sign * column_sign * h(r.difference, c.difference);
    if (r.sum >= 0) value += column_sign * h(r.sum, c.difference);
    if (c.sum >= 0) value += row_sign * h(r.difference, c.sum);
    if (r.sum >= 0 && c.sum >= 0) value += h(r.sum, c.sum);
    return value;
  };
  for (int end = 0; end < 2; ++end) {
    const double sign = end == 0 ? -1 : 1;
    BlockLdlt::Block block = matrix_.node_block(ends[end]);
    const int first = matrix_.first_row(ends[end]);
    for (const Axis& c : axes_[ends[end]]) {
      for (const Axis& r : axes_[ends[end]]) block(r.row, c.row) += entry(r, sign, c, sign);
      right_hand_side_[first + c.row] +=
          sign * right_hand_side[c.difference] + (c.sum >= 0 ? right_hand_side[c.sum] : 0.0);
      for (Eigen::Index q = 0; q < terms.border.cols(); ++q)
        border_(first + c.row, q) +=
            sign * terms.border(c.difference, q) + (c.sum >= 0 ? terms.border(c.sum, q) : 0.0);
    }
  }
  BlockLdlt::Block block = matrix_.edge_block(j);
  for (const Axis& c : axes_[ends[1]])
    for (const Axis& r : axes_[ends[0]]) block(r.row, c.row) += entry(r, -1, c, 1);
}

void KktSystem::add_nodes(const Iterate& it, const ProgramVector& gradient,
                          const Regularisation& regularisation) {
  const int n = program_.node_count();
  for (int i = 0; i < n; ++i) {
    BlockLdlt::Block block = matrix_.node_block(i);
    const int first = matrix_.first_row(i);
    for (int k = 0; k < cases_; ++k) {
      const int d = 3 * k, lambda = 3 * (cases_ + k);
      right_hand_side_.segment<3>(first + d) -= gradient.displacements[k].col(i);
      right_hand_side_.segment<3>(first + lambda) -= gradient.multipliers[k].col(i);
      block.block<3, 3>(d, d) += regularisation.primal * Matrix3d::Identity();
      block.block<3, 3>(lambda, lambda) -= regularisation.dual * Matrix3d::Identity();
      if (program_.squared_displacement_limit) {
        const int c = layout_.displacement_at(k, i, n);
        const double sigma = it.duals[c] / it.slacks[c];
        const Vector3d slope = 2 / *program_.squared_displacement_limit * it.point.displacements[k].col(i);
        block.block<3, 3>(d, d) +=
            2 * it.duals[c] / *program_.squared_displacement_limit * Matrix3d::Identity() +
            sigma * slope * slope.transpose();
        if (program_.elastic == ElasticScope::kLimits) {
          border_.block<3, 1>(first + d, layout_.row_count) -= sigma * slope;
          corner_(layout_.row_count, layout_.row_count) += sigma;
        }
      }
      for (int axis = 0; axis < 3; ++axis) {
        if (!program_.fixed[i][axis]) continue;
        for (const auto& [row, pivot] : {std::pair{d + axis, 1.0}, std::pair{lambda + axis, -1.0}}) {
          block.row(row).setZero();
          block.col(row).setZero();
          block(row, row) = pivot;
          right_hand_side_[first + row] = 0;
          border_.row(first + row).setZero();
        }
      }
    }
    if (program_.moves[i]) {
      const int x = 6 * cases_;
      block.block<3, 3>(x, x) += regularisation.primal * Matrix3d::Identity();
      right_hand_side_.segment<3>(first + x) -= gradient.positions.col(i);
    }
  }
  for (std::size_t h = 0; h < program_.half_spaces.size(); ++h) {
    const NodeHalfSpace& space = program_.half_spaces[h];
    const int c = layout_.half_space + static_cast<int>(h);
    matrix_.node_block(space.node).block<3, 3>(6 * cases_, 6 * cases_) +=
        it.duals[c] / it.slacks[c] * space.normal * space.normal.transpose();
  }
}

bool KktSystem::factorise() {
  if (!matrix_.factorise() || !(matrix_.inertia() == wanted_)) return false;
  if (corner_.rows() == 0) return true;
  solved_border_ = border_;
  matrix_.solve_in_place(solved_border_);
  schur_ = corner_ - border_.transpose() * solved_border_;
  if (!schur_.allFinite()) return false;
  const VectorXd eigenvalues =
      Eigen::SelfAdjointEigenSolver<MatrixXd>(schur_, Eigen::EigenvaluesOnly).eigenvalues();
  return (eigenvalues.array() < 0).count() == layout_.row_count &&
         (eigenvalues.array() > 0).count() == (has_elastic_ ? 1 : 0);
}

void KktSystem::back_substitute(const VectorXd& y, const VectorXd& r, VectorXd& nodes,
                                VectorXd& border) const {
  MatrixXd solution = y;
  matrix_.solve_in_place(solution);
  nodes = solution.col(0);
  border.resize(r.size());
  if (r.size() == 0) return;
  border = schur_.fullPivLu().solve(r - border_.transpose() * nodes);
  nodes -= solved_border_ * border;
}

KktStep KktSystem::solve() const {
  VectorXd nodes, border;
  back_substitute(right_hand_side_, border_right_, nodes, border);
  for (int pass = 0; pass < kRefinements; ++pass) {
    VectorXd y = right_hand_side_ - matrix_.multiply(nodes), r = border_right_;
    if (border.size() > 0) {
      y -= border_ * border;
      r -= border_.transpose() * nodes + corner_ * border;
    }
    if (y.size() == 0 || y.lpNorm<Infinity>() <= kRefinedEnough * (1 + right_hand_side_.lpNorm<Infinity>()))
      break;
    VectorXd more_nodes, more_border;
    back_substitute(y, r, more_nodes, more_border);
    nodes += more_nodes;
    border += more_border;
  }

  const int n = program_.node_count();
  ProgramVector step;
  step.positions = NodeMatrix::Zero(3, n);
  step.displacements.assign(cases_, NodeMatrix::Zero(3, n));
  step.multipliers = step.displacements;
  for (int i = 0; i < n; ++i) {
    const int first = matrix_.first_row(i);
    for (int k = 0; k < cases_; ++k) {
      step.displacements[k].col(i) = nodes.segment<3>(first + 3 * k);
      step.multipliers[k].col(i) = nodes.segment<3>(first + 3 * (cases_ + k));
    }
    if (program_.moves[i]) step.positions.col(i) = nodes.segment<3>(first + 6 * cases_);
  }
  if (has_elastic_) step.elastic = border[border.size() - 1];
  step.areas = VectorXd::Zero(program_.strut_count());
  for (int j = 0; j < program_.strut_count(); ++j) {
    if (program_.area_is_given(j)) continue;
    step.areas[j] = -(area_gradient_[j] + slopes_[j].dot(strut_coordinates(j, step)) +
                      row_areas_.col(j).dot(border.head(layout_.row_count))) /
                    curvatures_[j];
  }
  return {std::move(step), border.head(layout_.row_count)};
}

VectorXd KktSystem::strut_coordinates(int j, const ProgramVector& step) const {
  const auto [a, b] = program_.struts[j];
  VectorXd q(coordinates(j));
  for (int k = 0; k < cases_; ++k) {
    q.segment<3>(case_at(k)) = step.displacements[k].col(b) - step.displacements[k].col(a);
    q.segment<3>(case_at(k) + 3) = step.multipliers[k].col(b) - step.multipliers[k].col(a);
    q[case_at(k) + 6] = step.multipliers[k](2, a) + step.multipliers[k](2, b);
  }
  if (program_.strut_moves(j)) {
    q.segment<3>(geometry_at_) = step.positions.col(b) - step.positions.col(a);
    q.segment<3>(geometry_at_ + 3) = step.positions.col(b) + step.positions.col(a);
  }
  return q;
}

}  // namespace skinframe
