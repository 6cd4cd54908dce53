// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/scaled_program.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace skinframe {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;
using std::numbers::pi;

// The elastic scalar starts a little above what the start needs.
constexpr double kElasticRoom = 1.05;
// Balance rows are of the order of arm / mean length times this.
constexpr double kBalanceScale = 10;
// A given interval narrower than this, relative, is a given area.
constexpr double kNarrow = 1e-9;
// Geometry may shorten a strut: stress limits that |d| <= epsilon implies now need not hold then.
constexpr double kShortening = 0.5;

}  // namespace

void set_size_bounds(const FrameProblem& problem, ProgramRequest& request) {
  request.lower_mm2.clear();
  request.upper_mm2.clear();
  for (std::size_t j = 0; j < problem.frame.struts.size(); ++j) {
    const AreaBounds bounds = area_bounds(problem, static_cast<int>(j));
    request.lower_mm2.push_back(bounds.lower_mm2);
    request.upper_mm2.push_back(bounds.upper_mm2);
  }
}

ScaledProgram::ScaledProgram(const FrameProblem& problem, ProgramRequest request,
                             const std::vector<double>& start_mm2)
    : problem_(problem), request_(std::move(request)) {
  const Frame& frame = problem.frame;
  const int n = static_cast<int>(frame.nodes_mm.size()), m = static_cast<int>(frame.struts.size());
  double total_length = 0, total_volume = 0;
  for (int j = 0; j < m; ++j) {
    total_length += frame.length_mm(frame.struts[j]);
    total_volume += frame.length_mm(frame.struts[j]) * start_mm2[j];
  }
  scale_.length_mm = total_length / m;
  scale_.area_mm2 = total_volume / total_length;

  const std::vector<CaseResponse> responses = EquilibriumSolver(problem).solve(start_mm2, request_.cases);
  double largest = 0;
  for (const CaseResponse& response : responses) largest = std::max(largest, response.max_displacement_mm);
  if (problem.displacement_limit_mm)
    scale_.displacement_mm = request_.limit_factor * *problem.displacement_limit_mm;
  else
    scale_.displacement_mm = largest > 0 ? largest : scale_.length_mm;
  scale_.force_n =
      problem.material.tensile_modulus_mpa * scale_.area_mm2 * scale_.displacement_mm / scale_.length_mm;

  for (const Strut& strut : frame.struts) program_.struts.emplace_back(strut.a, strut.b);
  program_.fixed = problem.fixed;
  program_.moves.assign(n, false);
  program_.springs = strut_springs(problem.element, problem.material);
  program_.springs.shear /= program_.springs.axial;
  program_.springs.axial = 1;
  program_.springs.half_weight *= scale_.area_mm2 * scale_.length_mm / scale_.force_n;
  program_.lower.resize(m);
  program_.upper.resize(m);
  for (int j = 0; j < m; ++j) {
    program_.lower[j] = request_.lower_mm2[j] / scale_.area_mm2;
    program_.upper[j] = request_.upper_mm2[j] / scale_.area_mm2;
    if (program_.upper[j] - program_.lower[j] < kNarrow * program_.upper[j])
      program_.upper[j] = program_.lower[j];
  }
  if (problem.displacement_limit_mm) program_.squared_displacement_limit = 1;
  program_.elastic = request_.elastic;
  if (request_.elastic != ElasticScope::kNone) {
    program_.volume_weight = 0;
    program_.elastic_weight = m;  // as large as a volume
  }
  if (!request_.area_weights.empty()) {
    program_.volume_weight = 0;
    program_.area_weights = VectorXd::Map(request_.area_weights.data(), m);
  }
  if (request_.volume_cap_mm3)
    program_.volume_cap = *request_.volume_cap_mm3 / (scale_.area_mm2 * scale_.length_mm);

  start_.areas = VectorXd::Map(start_mm2.data(), m) / scale_.area_mm2;
  start_.positions.resize(3, n);
  for (int i = 0; i < n; ++i) start_.positions.col(i) = frame.nodes_mm[i] / scale_.length_mm;
  for (const CaseResponse& response : responses) {
    NodeMatrix displacements(3, n);
    for (int i = 0; i < n; ++i) displacements.col(i) = response.displacements_mm[i] / scale_.displacement_mm;
    start_.displacements.push_back(std::move(displacements));
    start_.multipliers.push_back(NodeMatrix::Zero(3, n));
  }
  add_cases();
  add_geometry();
  add_strain_limits();
  add_balance();
  add_warm_start();
  if (request_.elastic != ElasticScope::kNone) {
    const InequalityLayout layout(program_);
    const VectorXd c = inequalities(program_, layout, start_);  // t = 0 so far
    const int begin = request_.elastic == ElasticScope::kLimits ? layout.displacement : layout.rows;
    const int end = request_.elastic == ElasticScope::kLimits ? layout.slenderness : layout.count;
    for (int i = begin; i < end; ++i) start_.elastic = std::max(start_.elastic, kElasticRoom * c[i]);
  }
}

void ScaledProgram::add_cases() {
  const int n = program_.node_count();
  for (int k : request_.cases) {
    const LoadCase& load = problem_.load_cases[k];
    ProgramCase scaled{NodeMatrix(3, n), load.gravity ? 1.0 : 0.0};
    for (int i = 0; i < n; ++i) scaled.force.col(i) = load.force_n[i] / scale_.force_n;
    for (std::size_t i = 0; load.gravity && i < problem_.skin_weight_n.size(); ++i)
      scaled.force(2, i) -= problem_.skin_weight_n[i] / scale_.force_n;
    program_.cases.push_back(std::move(scaled));
  }
}

// |d| <= epsilon at both ends implies |delta| <= 2 epsilon, and with it (2) and (3) on every strut but the
// short ones. Of a strut that may vanish although its own bound is positive nothing is asked until it has
// stayed; but where there is no limit on d, its strain is all that keeps the frame up. For one load case that
// is no restriction: the strains of Michell's optimum exceed the limit nowhere.
void ScaledProgram::add_strain_limits() {
  const auto add = [&](StrainKind kind, const std::optional<double>& strength, double modulus) {
    if (!strength || modulus <= 0) return;
    const double strain = request_.limit_factor * *strength / modulus;
    for (int j = 0; j < program_.strut_count(); ++j) {
      if (problem_.displacement_limit_mm && request_.lower_mm2[j] == 0 &&
          area_bounds(problem_, j).lower_mm2 > 0)
        continue;
      double length = problem_.frame.length_mm(problem_.frame.struts[j]);
      if (program_.strut_moves(j)) length *= kShortening;
      if (problem_.displacement_limit_mm && 2 * scale_.displacement_mm <= strain * length) continue;
      const double scaled = strain * scale_.length_mm / scale_.displacement_mm;
      program_.strain_limits.push_back({j, kind, scaled * scaled});
    }
  };
  add(StrainKind::kAxial, problem_.material.tensile_strength_mpa, problem_.material.tensile_modulus_mpa);
  if (problem_.element == ElementModel::kPaper)
    add(StrainKind::kShear, problem_.material.shear_strength_mpa, problem_.material.shear_modulus_mpa);
  std::stable_sort(program_.strain_limits.begin(), program_.strain_limits.end(),
                   [](const StrainLimit& a, const StrainLimit& b) { return a.strut < b.strut; });
}

void ScaledProgram::add_balance() {
  const double weight = problem_.material.weight_density_n_mm3();
  if (!(weight > 0)) return;  // radii do not move the centre of gravity
  const double unit = weight * scale_.area_mm2 * scale_.length_mm * scale_.length_mm;
  for (const HalfPlane& edge : problem_.balance) {
    BalanceRow row;
    row.normal << edge.normal, 0;
    row.offset = edge.offset_mm / scale_.length_mm;
    row.skin_moment = problem_.skin_mass.weight_n *
                      (edge.normal.dot(problem_.skin_mass.centroid_mm.head<2>()) - edge.offset_mm) / unit;
    row.scale = kBalanceScale / program_.strut_count();
    program_.balance.push_back(row);
  }
}

void ScaledProgram::add_geometry() {
  for (std::size_t i = 0; i < request_.regions.size(); ++i)
    for (const HalfSpace& space : request_.regions[i]) {
      program_.moves[i] = true;
      program_.half_spaces.push_back({static_cast<int>(i), space.normal, space.offset_mm / scale_.length_mm});
    }
  if (request_.regions.empty()) return;
  if (problem_.material.slenderness)
    program_.slenderness_area = pi / (*problem_.material.slenderness * *problem_.material.slenderness) *
                                scale_.length_mm * scale_.length_mm / scale_.area_mm2;
  program_.squared_min_length.resize(program_.strut_count());
  for (int j = 0; j < program_.strut_count(); ++j)
    program_.squared_min_length[j] = std::pow(request_.min_length_mm[j] / scale_.length_mm, 2);
}

void ScaledProgram::add_warm_start() {
  const WarmStart& warm = request_.warm;
  const int n = program_.node_count();
  if (!warm.fits(n)) return;
  const InequalityLayout layout(program_);
  start_duals_ = VectorXd::Zero(layout.count);
  for (std::size_t k = 0; k < request_.cases.size(); ++k) {
    const auto known = std::find(warm.cases.begin(), warm.cases.end(), request_.cases[k]);
    if (known == warm.cases.end()) continue;
    const auto from = known - warm.cases.begin();
    for (int i = 0; i < n; ++i) {
      for (int axis = 0; axis < 3; ++axis)
        if (!program_.fixed[i][axis])
          start_.multipliers[k](axis, i) = warm.multipliers[from][i][axis] / multiplier_unit();
      if (program_.squared_displacement_limit)
        start_duals_[layout.displacement_at(static_cast<int>(k), i, n)] =
            warm.displacement_duals[from][i] / (scale_.area_mm2 * scale_.length_mm);
    }
  }
}

WarmStart ScaledProgram::warm_start(const ProgramVector& point, const VectorXd& duals) const {
  WarmStart warm;
  const int n = program_.node_count();
  const InequalityLayout layout(program_);
  warm.cases = request_.cases;
  for (std::size_t k = 0; k < request_.cases.size(); ++k) {
    warm.multipliers.emplace_back(n, Vector3d::Zero());
    warm.displacement_duals.emplace_back(n, 0.0);
    for (int i = 0; i < n; ++i) {
      warm.multipliers[k][i] = multiplier_unit() * point.multipliers[k].col(i);
      if (program_.squared_displacement_limit)
        warm.displacement_duals[k][i] =
            scale_.area_mm2 * scale_.length_mm * duals[layout.displacement_at(static_cast<int>(k), i, n)];
    }
  }
  return warm;
}

std::vector<double> ScaledProgram::areas_mm2(const ProgramVector& point) const {
  std::vector<double> areas(point.areas.size());
  for (std::size_t j = 0; j < areas.size(); ++j)
    areas[j] = std::clamp(point.areas[j] * scale_.area_mm2, request_.lower_mm2[j], request_.upper_mm2[j]);
  return areas;
}

NodeVectors ScaledProgram::positions_mm(const ProgramVector& point) const {
  NodeVectors positions = problem_.frame.nodes_mm;
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (program_.moves[i]) positions[i] = point.positions.col(i) * scale_.length_mm;
  return positions;
}

void ScaledProgram::restore_equilibrium(ProgramVector& point) const {
  FrameProblem moved = problem_;
  moved.frame.nodes_mm = positions_mm(point);
  const std::vector<CaseResponse> responses =
      EquilibriumSolver(moved).solve(areas_mm2(point), request_.cases);
  for (std::size_t k = 0; k < responses.size(); ++k)
    for (int i = 0; i < program_.node_count(); ++i)
      point.displacements[k].col(i) = responses[k].displacements_mm[i] / scale_.displacement_mm;
}

}  // namespace skinframe
