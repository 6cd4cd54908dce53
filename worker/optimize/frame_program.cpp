// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/frame_program.h"

#include <cmath>

namespace skinframe {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

Vector3d middle_of(const FrameProgram& p, const NodeMatrix& positions, int j) {
  return (positions.col(p.struts[j].first) + positions.col(p.struts[j].second)) / 2;
}

StrutState state_of(const FrameProgram& p, const ProgramVector& v, int j, int k) {
  const auto [a, b] = p.struts[j];
  return {strut_vector(p, v.positions, j), v.displacements[k].col(b) - v.displacements[k].col(a),
          v.multipliers[k].col(b) - v.multipliers[k].col(a),
          p.cases[k].gravity * (v.multipliers[k](2, a) + v.multipliers[k](2, b))};
}

void clear_fixed(const FrameProgram& p, NodeMatrix& vectors) {
  for (int i = 0; i < p.node_count(); ++i)
    for (int axis = 0; axis < 3; ++axis)
      if (p.fixed[i][axis]) vectors(axis, i) = 0;
}

// t where this family of inequalities is relaxed by it.
bool relaxes(const FrameProgram& p, ElasticScope scope) { return p.elastic == scope; }

double moment_arm(const BalanceRow& row, const Vector3d& middle) {
  return row.normal.dot(middle) - row.offset;
}

}  // namespace

void ProgramVector::add(double step, const ProgramVector& direction) {
  areas += step * direction.areas;
  positions += step * direction.positions;
  for (std::size_t k = 0; k < displacements.size(); ++k) {
    displacements[k] += step * direction.displacements[k];
    multipliers[k] += step * direction.multipliers[k];
  }
  elastic += step * direction.elastic;
}

InequalityLayout::InequalityLayout(const FrameProgram& p) {
  for (int j = 0; j < p.strut_count(); ++j)
    if (p.strut_moves(j)) geometry_struts.push_back(j);
  const int moving = static_cast<int>(geometry_struts.size());
  strain_count = static_cast<int>(p.strain_limits.size());
  row_count = static_cast<int>(p.balance.size()) + (p.volume_cap ? 1 : 0);

  area_upper = p.strut_count();
  displacement = area_upper + p.strut_count();
  strain = displacement + (p.squared_displacement_limit ? p.case_count() * p.node_count() : 0);
  slenderness = strain + p.case_count() * strain_count;
  length = slenderness + (p.slenderness_area > 0 ? moving : 0);
  half_space = length + (p.squared_min_length.size() > 0 ? moving : 0);
  rows = half_space + static_cast<int>(p.half_spaces.size());
  count = rows + row_count;
}

Vector3d strut_vector(const FrameProgram& p, const NodeMatrix& positions, int j) {
  return positions.col(p.struts[j].second) - positions.col(p.struts[j].first);
}

double program_volume(const FrameProgram& p, const ProgramVector& v) {
  double volume = 0;
  for (int j = 0; j < p.strut_count(); ++j) volume += v.areas[j] * strut_vector(p, v.positions, j).norm();
  return volume;
}

double objective(const FrameProgram& p, const ProgramVector& v) {
  double value = p.volume_weight * program_volume(p, v) + p.elastic_weight * v.elastic;
  if (p.area_weights.size() > 0) value += p.area_weights.dot(v.areas);
  return value;
}

std::vector<NodeMatrix> equilibrium_residuals(const FrameProgram& p, const ProgramVector& v) {
  std::vector<NodeMatrix> residuals;
  for (int k = 0; k < p.case_count(); ++k) {
    NodeMatrix residual = -p.cases[k].force;
    for (int j = 0; j < p.strut_count(); ++j) {
      const auto [a, b] = p.struts[j];
      const Vector3d e = strut_vector(p, v.positions, j);
      const double l = e.norm();
      const Vector3d delta = v.displacements[k].col(b) - v.displacements[k].col(a);
      const Vector3d force = v.areas[j] * (p.springs.shear / l * delta + (p.springs.axial - p.springs.shear) /
                                                                             (l * l * l) * e.dot(delta) * e);
      const double weight = p.cases[k].gravity * p.springs.half_weight * v.areas[j] * l;
      residual.col(a) -= force;
      residual.col(b) += force;
      residual(2, a) += weight;
      residual(2, b) += weight;
    }
    clear_fixed(p, residual);
    residuals.push_back(std::move(residual));
  }
  return residuals;
}

VectorXd inequalities(const FrameProgram& p, const InequalityLayout& at, const ProgramVector& v) {
  VectorXd c = VectorXd::Constant(at.count, -1.0);
  const int m = p.strut_count(), n = p.node_count();
  for (int j = 0; j < m; ++j) {
    if (p.area_is_given(j)) continue;
    c[at.area_lower + j] = p.lower[j] - v.areas[j];
    c[at.area_upper + j] = v.areas[j] - p.upper[j];
  }
  for (int k = 0; k < p.case_count(); ++k) {
    if (p.squared_displacement_limit)
      for (int i = 0; i < n; ++i)
        c[at.displacement_at(k, i, n)] =
            v.displacements[k].col(i).squaredNorm() / *p.squared_displacement_limit -
            (relaxes(p, ElasticScope::kLimits) ? v.elastic : 1.0);
    for (int s = 0; s < at.strain_count; ++s) {
      const StrainLimit& limit = p.strain_limits[s];
      const StrutState q = state_of(p, v, limit.strut, k);
      c[at.strain_at(k, s)] = squared_strain(limit.kind, q.e, q.delta) / limit.squared -
                              (relaxes(p, ElasticScope::kLimits) ? v.elastic : 1.0);
    }
  }
  for (std::size_t g = 0; g < at.geometry_struts.size(); ++g) {
    const int j = at.geometry_struts[g];
    const double l2 = strut_vector(p, v.positions, j).squaredNorm();
    if (p.slenderness_area > 0 && !p.area_is_given(j))
      c[at.slenderness + g] = p.slenderness_area * l2 - v.areas[j];
    if (p.squared_min_length.size() > 0) c[at.length + g] = p.squared_min_length[j] - l2;
  }
  for (std::size_t h = 0; h < p.half_spaces.size(); ++h)
    c[at.half_space + h] =
        p.half_spaces[h].normal.dot(v.positions.col(p.half_spaces[h].node)) - p.half_spaces[h].offset;
  int row = at.rows;
  for (const BalanceRow& balance : p.balance) {
    double moment = balance.skin_moment;
    for (int j = 0; j < m; ++j)
      moment += v.areas[j] * strut_vector(p, v.positions, j).norm() *
                moment_arm(balance, middle_of(p, v.positions, j));
    c[row++] = balance.scale * moment - (relaxes(p, ElasticScope::kBalance) ? v.elastic : 0.0);
  }
  if (p.volume_cap) c[row] = p.cap_scale * (program_volume(p, v) / *p.volume_cap - 1);
  return c;
}

ProgramVector lagrangian_gradient(const FrameProgram& p, const InequalityLayout& at, const ProgramVector& v,
                                  const VectorXd& w) {
  const int m = p.strut_count(), n = p.node_count();
  ProgramVector g;
  g.areas = p.area_weights.size() > 0 ? p.area_weights : VectorXd::Zero(m);
  g.positions = NodeMatrix::Zero(3, n);
  g.displacements.assign(p.case_count(), NodeMatrix::Zero(3, n));
  g.multipliers = equilibrium_residuals(p, v);
  g.elastic = p.elastic_weight;
  const double volume_weight =
      p.volume_weight + (p.volume_cap ? w[at.rows + at.row_count - 1] * p.cap_scale / *p.volume_cap : 0.0);

  // de: derivative with respect to e; dm: with respect to the middle of the strut.
  const auto add_to_positions = [&](int j, const Vector3d& de, const Vector3d& dm) {
    g.positions.col(p.struts[j].first) += dm / 2 - de;
    g.positions.col(p.struts[j].second) += dm / 2 + de;
  };
  for (int j = 0; j < m; ++j) {
    const auto [a, b] = p.struts[j];
    const bool moving = p.strut_moves(j);
    const double area = v.areas[j];
    const Vector3d e = strut_vector(p, v.positions, j);
    const double l = e.norm();
    Vector3d de = volume_weight * area / l * e, dm = Vector3d::Zero();
    g.areas[j] += volume_weight * l;
    if (!p.area_is_given(j)) g.areas[j] += w[at.area_upper + j] - w[at.area_lower + j];
    for (int k = 0; k < p.case_count(); ++k) {
      const StrutState q = state_of(p, v, j, k);
      g.areas[j] += strut_work(p.springs, q);
      const StrutGradient dq = strut_work_gradient(p.springs, q);
      de += area * dq.segment<3>(0);
      g.displacements[k].col(a) -= area * dq.segment<3>(3);
      g.displacements[k].col(b) += area * dq.segment<3>(3);
    }
    for (std::size_t r = 0; r < p.balance.size(); ++r) {
      const double weight = w[at.rows + r] * p.balance[r].scale;
      const double arm = moment_arm(p.balance[r], middle_of(p, v.positions, j));
      g.areas[j] += weight * l * arm;
      de += weight * area * arm / l * e;
      dm += weight * area * l * p.balance[r].normal;
    }
    if (moving) add_to_positions(j, de, dm);
  }
  for (int k = 0; k < p.case_count(); ++k) {
    if (p.squared_displacement_limit)
      for (int i = 0; i < n; ++i) {
        const double weight = w[at.displacement_at(k, i, n)];
        g.displacements[k].col(i) += 2 * weight / *p.squared_displacement_limit * v.displacements[k].col(i);
        if (relaxes(p, ElasticScope::kLimits)) g.elastic -= weight;
      }
    for (int s = 0; s < at.strain_count; ++s) {
      const StrainLimit& limit = p.strain_limits[s];
      const double weight = w[at.strain_at(k, s)];
      const StrutState q = state_of(p, v, limit.strut, k);
      const StrainGradient dq = weight / limit.squared * squared_strain_gradient(limit.kind, q.e, q.delta);
      g.displacements[k].col(p.struts[limit.strut].first) -= dq.tail<3>();
      g.displacements[k].col(p.struts[limit.strut].second) += dq.tail<3>();
      if (p.strut_moves(limit.strut)) add_to_positions(limit.strut, dq.head<3>(), Vector3d::Zero());
      if (relaxes(p, ElasticScope::kLimits)) g.elastic -= weight;
    }
  }
  for (std::size_t i = 0; i < at.geometry_struts.size(); ++i) {
    const int j = at.geometry_struts[i];
    const Vector3d e = strut_vector(p, v.positions, j);
    Vector3d de = Vector3d::Zero();
    if (p.slenderness_area > 0 && !p.area_is_given(j)) {
      g.areas[j] -= w[at.slenderness + i];
      de += 2 * w[at.slenderness + i] * p.slenderness_area * e;
    }
    if (p.squared_min_length.size() > 0) de -= 2 * w[at.length + i] * e;
    add_to_positions(j, de, Vector3d::Zero());
  }
  for (std::size_t h = 0; h < p.half_spaces.size(); ++h)
    g.positions.col(p.half_spaces[h].node) += w[at.half_space + h] * p.half_spaces[h].normal;
  if (relaxes(p, ElasticScope::kBalance))
    for (std::size_t r = 0; r < p.balance.size(); ++r) g.elastic -= w[at.rows + r];

  for (NodeMatrix& part : g.displacements) clear_fixed(p, part);
  for (int i = 0; i < n; ++i)
    if (!p.moves[i]) g.positions.col(i).setZero();
  for (int j = 0; j < m; ++j)
    if (p.area_is_given(j)) g.areas[j] = 0;
  return g;
}

VectorXd inequality_slopes(const FrameProgram& p, const InequalityLayout& at, const ProgramVector& v,
                           const ProgramVector& d) {
  VectorXd slopes = VectorXd::Zero(at.count);
  const int m = p.strut_count(), n = p.node_count();
  for (int j = 0; j < m; ++j) {
    if (p.area_is_given(j)) continue;
    slopes[at.area_lower + j] = -d.areas[j];
    slopes[at.area_upper + j] = d.areas[j];
  }
  const double relaxed = relaxes(p, ElasticScope::kLimits) ? d.elastic : 0.0;
  for (int k = 0; k < p.case_count(); ++k) {
    if (p.squared_displacement_limit)
      for (int i = 0; i < n; ++i)
        slopes[at.displacement_at(k, i, n)] =
            2 * v.displacements[k].col(i).dot(d.displacements[k].col(i)) / *p.squared_displacement_limit -
            relaxed;
    for (int s = 0; s < at.strain_count; ++s) {
      const StrainLimit& limit = p.strain_limits[s];
      const StrutState q = state_of(p, v, limit.strut, k), dq = state_of(p, d, limit.strut, k);
      StrainGradient step;
      step << dq.e, dq.delta;
      slopes[at.strain_at(k, s)] =
          squared_strain_gradient(limit.kind, q.e, q.delta).dot(step) / limit.squared - relaxed;
    }
  }
  for (std::size_t i = 0; i < at.geometry_struts.size(); ++i) {
    const int j = at.geometry_struts[i];
    const double along = 2 * strut_vector(p, v.positions, j).dot(strut_vector(p, d.positions, j));
    if (p.slenderness_area > 0 && !p.area_is_given(j))
      slopes[at.slenderness + i] = p.slenderness_area * along - d.areas[j];
    if (p.squared_min_length.size() > 0) slopes[at.length + i] = -along;
  }
  for (std::size_t h = 0; h < p.half_spaces.size(); ++h)
    slopes[at.half_space + h] = p.half_spaces[h].normal.dot(d.positions.col(p.half_spaces[h].node));
  const auto volume_slope = [&](int j) {
    const Vector3d e = strut_vector(p, v.positions, j);
    return d.areas[j] * e.norm() + v.areas[j] * e.dot(strut_vector(p, d.positions, j)) / e.norm();
  };
  for (std::size_t r = 0; r < p.balance.size(); ++r) {
    double slope = 0;
    for (int j = 0; j < m; ++j)
      slope += volume_slope(j) * moment_arm(p.balance[r], middle_of(p, v.positions, j)) +
               v.areas[j] * strut_vector(p, v.positions, j).norm() *
                   p.balance[r].normal.dot(middle_of(p, d.positions, j));
    slopes[at.rows + r] = p.balance[r].scale * slope - (relaxes(p, ElasticScope::kBalance) ? d.elastic : 0.0);
  }
  if (p.volume_cap) {
    double slope = 0;
    for (int j = 0; j < m; ++j) slope += volume_slope(j);
    slopes[at.rows + at.row_count - 1] = p.cap_scale * slope / *p.volume_cap;
  }
  return slopes;
}

double objective_slope(const FrameProgram& p, const ProgramVector& v, const ProgramVector& d) {
  double slope = p.elastic_weight * d.elastic;
  if (p.area_weights.size() > 0) slope += p.area_weights.dot(d.areas);
  if (p.volume_weight == 0) return slope;
  for (int j = 0; j < p.strut_count(); ++j) {
    const Vector3d e = strut_vector(p, v.positions, j);
    slope += p.volume_weight *
             (d.areas[j] * e.norm() + v.areas[j] * e.dot(strut_vector(p, d.positions, j)) / e.norm());
  }
  return slope;
}

}  // namespace skinframe
