// SPDX-License-Identifier: Apache-2.0
#include "tests/oracle/size_program.h"

#include <algorithm>
#include <cmath>

namespace oracle {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Ipopt::Index;
using Ipopt::Number;

constexpr double kInfinity = 2e19;  // Ipopt's own
constexpr double kBaseScale = 10;   // moments of the base edges, in units of the mean strut's

Matrix3d across(const FrameStrut& strut) {
  return Matrix3d::Identity() - strut.direction * strut.direction.transpose();
}

}  // namespace

SizeProgram::SizeProgram(const FrameFile& frame, const Start& start, bool every_strain)
    : frame_(frame), start_(start) {
  double length = 0, volume = 0;
  for (std::size_t j = 0; j < frame.struts.size(); ++j) {
    length += frame.struts[j].length;
    volume += frame.struts[j].length * start.areas[j];
  }
  length_unit_ = length / strut_count();
  area_unit_ = volume / length;
  double largest = 0;
  for (const auto& displacements : start.displacements)
    for (const Vector3d& d : displacements) largest = std::max(largest, d.norm());
  displacement_unit_ = frame.displacement_limit.value_or(largest > 0 ? largest : length_unit_);
  force_unit_ = frame.tension * area_unit_ * displacement_unit_ / length_unit_;

  for (std::size_t i = 0; i < frame.nodes.size(); ++i) {
    free_.push_back({-1, -1, -1});
    for (int axis = 0; axis < 3; ++axis)
      if (!frame.fixed[i][axis]) free_.back()[axis] = free_count_++;
    if (frame.displacement_limit && free_.back() != std::array<int, 3>{-1, -1, -1})
      limited_nodes_.push_back(static_cast<int>(i));
  }
  const auto select = [&](const std::optional<double>& strength, double modulus, std::vector<int>& struts) {
    if (!strength || modulus <= 0) return;
    for (int j = 0; j < strut_count(); ++j) {
      const bool implied = frame.displacement_limit &&
                           2 * *frame.displacement_limit <= *strength / modulus * frame.struts[j].length;
      if (every_strain || !implied) struts.push_back(j);
    }
  };
  select(frame.tensile_strength, frame.tension, axial_struts_);
  select(frame.shear_strength, frame.shear, shear_struts_);

  first_limit_ = case_count() * free_count_;
  first_axial_ = first_limit_ + case_count() * static_cast<int>(limited_nodes_.size());
  first_shear_ = first_axial_ + case_count() * static_cast<int>(axial_struts_.size());
  first_base_ = first_shear_ + case_count() * static_cast<int>(shear_struts_.size());
  rows_ = first_base_ + static_cast<int>(frame.base.size());
}

double SizeProgram::volume() const {
  double volume = 0;
  for (std::size_t j = 0; j < areas_.size(); ++j) volume += areas_[j] * frame_.struts[j].length;
  return volume;
}

int SizeProgram::displacement(int load_case, int node, int axis) const {
  const int number = free_[node][axis];
  return number < 0 ? -1 : strut_count() + load_case * free_count_ + number;
}

int SizeProgram::equilibrium_row(int load_case, int node, int axis) const {
  const int number = free_[node][axis];
  return number < 0 ? -1 : load_case * free_count_ + number;
}

Vector3d SizeProgram::moved(const Number* x, int load_case, int node) const {
  Vector3d d = Vector3d::Zero();
  for (int axis = 0; axis < 3; ++axis)
    if (const int at = displacement(load_case, node, axis); at >= 0) d[axis] = x[at];
  return d;
}

Vector3d SizeProgram::stretch(const Number* x, int load_case, const FrameStrut& strut) const {
  return moved(x, load_case, strut.b) - moved(x, load_case, strut.a);
}

Matrix3d SizeProgram::stiffness(const FrameStrut& strut) const {
  const double scale = length_unit_ / strut.length;
  const double g = frame_.shear / frame_.tension;
  return scale * (strut.direction * strut.direction.transpose() + g * across(strut));
}

double SizeProgram::axial_scale(const FrameStrut& strut) const {
  return displacement_unit_ / (*frame_.tensile_strength / frame_.tension * strut.length);
}

double SizeProgram::shear_scale(const FrameStrut& strut) const {
  return displacement_unit_ / (*frame_.shear_strength / frame_.shear * strut.length);
}

double SizeProgram::half_weight(int load_case, const FrameStrut& strut) const {
  return frame_.cases[load_case].gravity ? frame_.weight * strut.length / 2 * area_unit_ / force_unit_ : 0;
}

bool SizeProgram::get_nlp_info(Index& n, Index& m, Index& jacobian, Index& hessian, IndexStyleEnum& style) {
  n = strut_count() + case_count() * free_count_;
  m = rows_;
  jacobian = hessian = 0;
  const std::vector<Number> x(n, 0), lambda(m, 0);
  walk_jacobian(x.data(), [&](int, int, double) { ++jacobian; });
  walk_hessian(lambda.data(), [&](int, int, double) { ++hessian; });
  style = C_STYLE;
  return true;
}

bool SizeProgram::get_bounds_info(Index n, Number* xl, Number* xu, Index m, Number* gl, Number* gu) {
  std::fill(xl, xl + n, -kInfinity);
  std::fill(xu, xu + n, kInfinity);
  for (int j = 0; j < strut_count(); ++j) {
    xl[j] = frame_.struts[j].least_area / area_unit_;
    xu[j] = frame_.struts[j].most_area / area_unit_;
  }
  std::fill(gl, gl + m, -kInfinity);
  std::fill(gu, gu + m, 0);
  std::fill(gl, gl + first_limit_, 0);
  std::fill(gu + first_limit_, gu + first_axial_, 1);
  std::fill(gl + first_axial_, gl + first_shear_, -1);
  std::fill(gu + first_axial_, gu + first_base_, 1);
  return true;
}

bool SizeProgram::get_starting_point(Index n, bool, Number* x, bool, Number*, Number*, Index, bool, Number*) {
  std::fill(x, x + n, 0);
  for (int j = 0; j < strut_count(); ++j) x[j] = start_.areas[j] / area_unit_;
  for (int k = 0; k < case_count(); ++k)
    for (std::size_t i = 0; i < free_.size(); ++i)
      for (int axis = 0; axis < 3; ++axis)
        if (const int at = displacement(k, static_cast<int>(i), axis); at >= 0)
          x[at] = start_.displacements[k][i][axis] / displacement_unit_;
  return true;
}

bool SizeProgram::eval_f(Index, const Number* x, bool, Number& f) {
  f = 0;
  for (int j = 0; j < strut_count(); ++j) f += x[j] * frame_.struts[j].length / length_unit_;
  return true;
}

bool SizeProgram::eval_grad_f(Index n, const Number*, bool, Number* gradient) {
  std::fill(gradient, gradient + n, 0);
  for (int j = 0; j < strut_count(); ++j) gradient[j] = frame_.struts[j].length / length_unit_;
  return true;
}

bool SizeProgram::eval_g(Index, const Number* x, bool, Index m, Number* g) {
  std::fill(g, g + m, 0);
  for (int k = 0; k < case_count(); ++k) {
    const auto add = [&](int node, const Vector3d& force) {
      for (int axis = 0; axis < 3; ++axis)
        if (const int row = equilibrium_row(k, node, axis); row >= 0) g[row] += force[axis];
    };
    for (std::size_t i = 0; i < free_.size(); ++i)
      add(static_cast<int>(i), -frame_.cases[k].force[i] / force_unit_);
    for (int j = 0; j < strut_count(); ++j) {
      const FrameStrut& strut = frame_.struts[j];
      const Vector3d pull = x[j] * (stiffness(strut) * stretch(x, k, strut));
      const Vector3d weight = x[j] * half_weight(k, strut) * Vector3d::UnitZ();
      add(strut.a, weight - pull);
      add(strut.b, weight + pull);
    }
    int row = first_limit_ + k * static_cast<int>(limited_nodes_.size());
    for (const int i : limited_nodes_) g[row++] = moved(x, k, i).squaredNorm();
    row = first_axial_ + k * static_cast<int>(axial_struts_.size());
    for (const int j : axial_struts_)
      g[row++] =
          axial_scale(frame_.struts[j]) * frame_.struts[j].direction.dot(stretch(x, k, frame_.struts[j]));
    row = first_shear_ + k * static_cast<int>(shear_struts_.size());
    for (const int j : shear_struts_)
      g[row++] =
          (shear_scale(frame_.struts[j]) * (across(frame_.struts[j]) * stretch(x, k, frame_.struts[j])))
              .squaredNorm();
  }
  const double unit = frame_.weight * area_unit_ * length_unit_ * length_unit_ * strut_count() / kBaseScale;
  for (std::size_t e = 0; e < frame_.base.size() && frame_.weight > 0; ++e)
    g[first_base_ + e] = frame_.skin_weight *
                         (frame_.base[e].normal.dot(frame_.skin_centroid.head<2>()) - frame_.base[e].offset) /
                         unit;
  walk_jacobian(x, [&](int row, int column, double value) {
    if (row >= first_base_) g[row] += value * x[column];
  });
  return true;
}

template <class Emit>
void SizeProgram::walk_jacobian(const Number* x, const Emit& emit) const {
  for (int k = 0; k < case_count(); ++k) {
    for (int j = 0; j < strut_count(); ++j) {
      const FrameStrut& strut = frame_.struts[j];
      const Matrix3d unit = stiffness(strut), block = x[j] * unit;
      const Vector3d pull = unit * stretch(x, k, strut);
      for (const int end : {strut.a, strut.b}) {
        const double sign = end == strut.b ? 1 : -1;
        for (int axis = 0; axis < 3; ++axis) {
          const int row = equilibrium_row(k, end, axis);
          if (row < 0) continue;
          emit(row, j, sign * pull[axis] + (axis == 2 ? half_weight(k, strut) : 0));
          for (const int other : {strut.a, strut.b})
            for (int along = 0; along < 3; ++along)
              if (const int column = displacement(k, other, along); column >= 0)
                emit(row, column, (other == end ? 1 : -1) * block(axis, along));
        }
      }
    }
    const auto emit_ends = [&](int row, const FrameStrut& strut, const Vector3d& slope) {
      for (int axis = 0; axis < 3; ++axis) {
        if (const int at = displacement(k, strut.a, axis); at >= 0) emit(row, at, -slope[axis]);
        if (const int at = displacement(k, strut.b, axis); at >= 0) emit(row, at, slope[axis]);
      }
    };
    int row = first_limit_ + k * static_cast<int>(limited_nodes_.size());
    for (const int i : limited_nodes_) {
      for (int axis = 0; axis < 3; ++axis)
        if (const int at = displacement(k, i, axis); at >= 0) emit(row, at, 2 * x[at]);
      ++row;
    }
    row = first_axial_ + k * static_cast<int>(axial_struts_.size());
    for (const int j : axial_struts_)
      emit_ends(row++, frame_.struts[j], axial_scale(frame_.struts[j]) * frame_.struts[j].direction);
    row = first_shear_ + k * static_cast<int>(shear_struts_.size());
    for (const int j : shear_struts_) {
      const FrameStrut& strut = frame_.struts[j];
      emit_ends(row++, strut, 2 * std::pow(shear_scale(strut), 2) * (across(strut) * stretch(x, k, strut)));
    }
  }
  if (!(frame_.weight > 0)) return;
  for (std::size_t e = 0; e < frame_.base.size(); ++e)
    for (int j = 0; j < strut_count(); ++j) {
      const FrameStrut& strut = frame_.struts[j];
      const Eigen::Vector2d middle = (frame_.nodes[strut.a] + frame_.nodes[strut.b]).head<2>() / 2;
      emit(first_base_ + static_cast<int>(e), j,
           strut.length * (frame_.base[e].normal.dot(middle) - frame_.base[e].offset) * kBaseScale /
               (length_unit_ * length_unit_ * strut_count()));
    }
}

template <class Emit>
void SizeProgram::walk_hessian(const Number* lambda, const Emit& emit) const {
  const auto multiplier = [&](int k, int node) {
    Vector3d v = Vector3d::Zero();
    for (int axis = 0; axis < 3; ++axis)
      if (const int row = equilibrium_row(k, node, axis); row >= 0) v[axis] = lambda[row];
    return v;
  };
  for (int k = 0; k < case_count(); ++k) {
    for (int j = 0; j < strut_count(); ++j) {
      const FrameStrut& strut = frame_.struts[j];
      const Vector3d slope = stiffness(strut) * (multiplier(k, strut.b) - multiplier(k, strut.a));
      for (int axis = 0; axis < 3; ++axis) {
        if (const int at = displacement(k, strut.a, axis); at >= 0) emit(at, j, -slope[axis]);
        if (const int at = displacement(k, strut.b, axis); at >= 0) emit(at, j, slope[axis]);
      }
    }
    int row = first_limit_ + k * static_cast<int>(limited_nodes_.size());
    for (const int i : limited_nodes_) {
      for (int axis = 0; axis < 3; ++axis)
        if (const int at = displacement(k, i, axis); at >= 0) emit(at, at, 2 * lambda[row]);
      ++row;
    }
    row = first_shear_ + k * static_cast<int>(shear_struts_.size());
    for (const int j : shear_struts_) {
      const FrameStrut& strut = frame_.struts[j];
      const Matrix3d curvature = 2 * lambda[row++] * std::pow(shear_scale(strut), 2) * across(strut);
      const int ends[2] = {strut.a, strut.b};
      for (int p = 0; p < 6; ++p)
        for (int q = 0; q < 6; ++q) {
          const int at = displacement(k, ends[p / 3], p % 3), other = displacement(k, ends[q / 3], q % 3);
          if (at < 0 || other < 0 || at < other) continue;
          emit(at, other, (p / 3 == q / 3 ? 1 : -1) * curvature(p % 3, q % 3));
        }
    }
  }
}

bool SizeProgram::eval_jac_g(Index, const Number* x, bool, Index, Index, Index* rows, Index* columns,
                             Number* values) {
  Index at = 0;
  if (values) {
    walk_jacobian(x, [&](int, int, double value) { values[at++] = value; });
    return true;
  }
  const std::vector<Number> zero(strut_count() + case_count() * free_count_, 0);
  walk_jacobian(zero.data(), [&](int row, int column, double) {
    rows[at] = row;
    columns[at++] = column;
  });
  return true;
}

bool SizeProgram::eval_h(Index, const Number*, bool, Number, Index m, const Number* lambda, bool, Index,
                         Index* rows, Index* columns, Number* values) {
  Index at = 0;
  if (values) {
    walk_hessian(lambda, [&](int, int, double value) { values[at++] = value; });
    return true;
  }
  const std::vector<Number> zero(m, 0);
  walk_hessian(zero.data(), [&](int row, int column, double) {
    rows[at] = row;
    columns[at++] = column;
  });
  return true;
}

void SizeProgram::finalize_solution(Ipopt::SolverReturn, Index, const Number* x, const Number*, const Number*,
                                    Index, const Number*, const Number*, Number, const Ipopt::IpoptData*,
                                    Ipopt::IpoptCalculatedQuantities*) {
  areas_.clear();
  for (int j = 0; j < strut_count(); ++j)
    areas_.push_back(std::clamp(x[j] * area_unit_, frame_.struts[j].least_area, frame_.struts[j].most_area));
}

}  // namespace oracle
