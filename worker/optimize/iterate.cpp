// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/iterate.h"

#include <algorithm>
#include <cmath>

namespace skinframe {
namespace {

using Eigen::Infinity;
using Eigen::VectorXd;

constexpr double kMultiplierScale = 100;  // s_max: below this mean multiplier errors are not scaled
constexpr double kSlackFloor = 1e-2;
constexpr double kPushIntoBounds = 1e-2;  // share of the interval
constexpr double kLargestPush = 0.05;

}  // namespace

KktError kkt_error(const FrameProgram& program, const InequalityLayout& layout, const Iterate& iterate,
                   double barrier) {
  const ProgramVector gradient = lagrangian_gradient(program, layout, iterate.point, iterate.duals);
  const VectorXd c = inequalities(program, layout, iterate.point);
  KktError error;
  error.dual = std::abs(gradient.elastic);
  if (program.elastic == ElasticScope::kNone) error.dual = 0;
  error.dual = std::max(error.dual, gradient.areas.lpNorm<Infinity>());
  error.dual = std::max(error.dual, gradient.positions.lpNorm<Infinity>());
  error.primal = (c + iterate.slacks).lpNorm<Infinity>();
  double multipliers = iterate.duals.sum();
  for (int k = 0; k < program.case_count(); ++k) {
    error.dual = std::max(error.dual, gradient.displacements[k].lpNorm<Infinity>());
    error.primal = std::max(error.primal, gradient.multipliers[k].lpNorm<Infinity>());
    multipliers += iterate.point.multipliers[k].lpNorm<1>();
  }
  error.complementarity = (iterate.duals.cwiseProduct(iterate.slacks).array() - barrier).abs().maxCoeff();
  const double count = layout.count + 3.0 * program.node_count() * program.case_count();
  const double scale = std::max(1.0, multipliers / (kMultiplierScale * count));
  error.dual /= scale;
  error.complementarity /= scale;
  return error;
}

Iterate start_iterate(const FrameProgram& program, const InequalityLayout& layout, ProgramVector point,
                      double barrier, const VectorXd& known_duals) {
  const bool warm = known_duals.size() > 0;
  const VectorXd slope = warm ? lagrangian_gradient(program, layout, point, known_duals).areas
                              : VectorXd::Zero(program.strut_count());
  // How far off a bound that pulls with this slope.
  const auto central = [&](double pull, double push) {
    return pull * push > barrier ? barrier / pull : push;
  };
  for (int j = 0; j < program.strut_count(); ++j) {
    if (program.area_is_given(j)) {
      point.areas[j] = program.lower[j];
      continue;
    }
    const double push = std::min(kPushIntoBounds * (program.upper[j] - program.lower[j]), kLargestPush);
    point.areas[j] = std::clamp(point.areas[j], program.lower[j] + central(slope[j], push),
                                program.upper[j] - central(-slope[j], push));
  }
  const VectorXd c = inequalities(program, layout, point);
  Iterate iterate{std::move(point), (-c).cwiseMax(kSlackFloor), VectorXd()};
  for (int i = 0; i < layout.displacement; ++i) iterate.slacks[i] = -c[i];
  for (int i = layout.half_space; i < layout.rows; ++i)
    if (c[i] < 0) iterate.slacks[i] = -c[i];
  for (int i = layout.displacement; warm && i < layout.slenderness; ++i)
    if (known_duals[i] * kSlackFloor > barrier) iterate.slacks[i] = std::max(-c[i], barrier / known_duals[i]);
  iterate.duals = barrier * iterate.slacks.cwiseInverse();
  return iterate;
}

void follow_point(const FrameProgram& program, const InequalityLayout& layout, Iterate& iterate) {
  const VectorXd room = -inequalities(program, layout, iterate.point);
  for (int i = 0; i < layout.count; ++i) {
    const bool linear = i < layout.displacement || (i >= layout.half_space && i < layout.rows);
    if (room[i] > iterate.slacks[i] || (linear && room[i] > 0)) iterate.slacks[i] = room[i];
  }
}

}  // namespace skinframe
