// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/newton_step.h"

namespace skinframe {

NewtonStep complete_step(const FrameProgram& program, const InequalityLayout& layout, const Iterate& it,
                         double barrier, KktStep solved) {
  NewtonStep step;
  step.point = std::move(solved.point);
  step.slacks = -(inequalities(program, layout, it.point) + it.slacks) -
                inequality_slopes(program, layout, it.point, step.point);
  step.duals =
      ((barrier - it.duals.array() * step.slacks.array()) / it.slacks.array() - it.duals.array()).matrix();
  for (int r = 0; r < layout.row_count; ++r) {
    const int i = layout.rows + r;
    const double s = it.slacks[i], z = it.duals[i];
    step.duals[i] = solved.row_duals[r];
    step.slacks[i] = (barrier - s * step.duals[i]) / z - s;
  }
  return step;
}

}  // namespace skinframe
