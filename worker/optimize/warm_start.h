// SPDX-License-Identifier: GPL-3.0-or-later
// The dual side of a solved program, in mm and N: where the program of a near frame (fewer struts, moved
// nodes) starts from. With zero multipliers the first steps of a program shrink every area far below what
// holds, and many more mend that.
#pragma once

#include <vector>

#include "worker/mechanics/equilibrium.h"

namespace skinframe {

struct WarmStart {
  std::vector<int> cases;                               // load cases that took part
  std::vector<NodeVectors> multipliers;                 // of (1), d volume / d force, mm3/N: one list a case
  std::vector<std::vector<double>> displacement_duals;  // of |d|^2 / limit^2 <= 1, mm3: one list a case

  bool empty() const { return cases.empty(); }
  bool fits(std::size_t nodes) const { return !empty() && multipliers.front().size() == nodes; }
};

// The same for a frame in which node i of this one is number renumbered[i], or is gone (-1).
WarmStart renumbered(const WarmStart& warm, const std::vector<int>& renumbered, int nodes);

}  // namespace skinframe
