// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/optimize/warm_start.h"

namespace skinframe {

WarmStart renumbered(const WarmStart& warm, const std::vector<int>& renumbered, int nodes) {
  WarmStart to;
  if (!warm.fits(renumbered.size())) return to;
  to.cases = warm.cases;
  for (std::size_t k = 0; k < warm.cases.size(); ++k) {
    to.multipliers.emplace_back(nodes, Eigen::Vector3d::Zero());
    to.displacement_duals.emplace_back(nodes, 0.0);
    for (std::size_t i = 0; i < renumbered.size(); ++i) {
      if (renumbered[i] < 0) continue;
      to.multipliers[k][renumbered[i]] = warm.multipliers[k][i];
      to.displacement_duals[k][renumbered[i]] = warm.displacement_duals[k][i];
    }
  }
  return to;
}

}  // namespace skinframe
