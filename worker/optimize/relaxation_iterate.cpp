// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/relaxation_iterate.h"

#include <algorithm>

namespace skinframe {
namespace {

using Eigen::Vector3d;

// All that is linear in the step.
void move(const RelaxationIterate& step, double length, RelaxationIterate* at) {
  at->point.areas += length * step.point.areas;
  at->point.multipliers += length * step.point.multipliers;
  at->below_dual += length * step.below_dual;
  at->above_dual += length * step.above_dual;
  at->slacks += length * step.slacks;
  at->excess_bound += length * step.excess_bound;
  at->excess_slack += length * step.excess_slack;
}

}  // namespace

double mean_product(const Relaxation& p, const RelaxationIterate& at, bool bounded_excess) {
  double sum = at.slacks.dot(at.point.multipliers) + at.excess_bound * at.excess_slack;
  int count = p.term_count() + (bounded_excess ? 1 : 0);
  for (int j = 0; j < p.strut_count(); ++j) {
    if (p.area_is_given(j)) continue;
    sum += at.below_dual[j] * (at.point.areas[j] - p.lower[j]) +
           at.above_dual[j] * (p.upper[j] - at.point.areas[j]);
    count += 2;
  }
  return sum / std::max(count, 1);
}

double mean_product_after(const Relaxation& p, const RelaxationIterate& at, const RelaxationIterate& step,
                          double length, bool bounded_excess) {
  RelaxationIterate moved = at;
  move(step, length, &moved);
  return mean_product(p, moved, bounded_excess);
}

double step_length(const Relaxation& p, const RelaxationIterate& at, const RelaxationIterate& step,
                   double share, bool bounded_excess) {
  double length = 1;
  const auto limit = [&](double value, double change) {
    if (change < 0) length = std::min(length, -share * value / change);
  };
  for (int j = 0; j < p.strut_count(); ++j) {
    if (p.area_is_given(j)) continue;
    limit(at.point.areas[j] - p.lower[j], step.point.areas[j]);
    limit(p.upper[j] - at.point.areas[j], -step.point.areas[j]);
    limit(at.below_dual[j], step.below_dual[j]);
    limit(at.above_dual[j], step.above_dual[j]);
  }
  for (int c = 0; c < p.term_count(); ++c) {
    limit(at.point.multipliers[c], step.point.multipliers[c]);
    limit(at.slacks[c], step.slacks[c]);
  }
  if (bounded_excess) {
    limit(at.excess_bound, step.excess_bound);
    limit(at.excess_slack, step.excess_slack);
  }
  return length;
}

void advance(const Relaxation& p, const RelaxationValues& values, const RelaxationIterate& step,
             double length, RelaxationIterate* at) {
  const int cases = p.case_count();
  move(step, length, at);
  // To first order the fields' own step, but taken in y = w / u: where a load case does not bind, u falls
  // to nothing within a few steps, and a w that does not fall with it would be a huge displacement.
  for (int k = 0; k < cases; ++k) {
    const double weight = case_weight(p, at->point, k), change = (weight - values.weights[k]) / length;
    for (int i = 0; i < static_cast<int>(p.fixed.size()); ++i) {
      const int at_node = 3 * (cases * i + k);
      const Vector3d y = values.displacements.segment<3>(at_node);
      const Vector3d dy = (step.point.fields.segment<3>(at_node) - change * y) / values.weights[k];
      at->point.fields.segment<3>(at_node) = weight * (y + length * dy);
    }
  }
}

}  // namespace skinframe
