// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies given by formulas, and a printer that leans 45 degrees and bridges 10 mm.
#pragma once

#include "worker/support/plan_supports.h"

namespace skinframe::test {

inline PrintableLength bridges_10_mm() {
  auto curve = PrintableLength::make({{45, std::nullopt}, {46, 10.0}, {90, 10.0}}, false, "made up");
  SKINFRAME_CHECK(curve.ok());
  return std::move(curve).value();
}

// A hall without walls or roof: its floor is the skin below z = 1.
inline PrintedBody hall() {
  return {[](const Eigen::Vector3d& p) { return p.z(); },
          [](const Eigen::Vector3d&) { return Eigen::Vector3d(0, 0, -1); }, 1.0, 0.0, 0.25};
}

// A plate 2 mm thick whose underside is 30 mm above the base plane.
inline PrintedBody table_top() {
  return {[](const Eigen::Vector3d& p) { return std::min(p.z() - 30.0, 32.0 - p.z()); },
          [](const Eigen::Vector3d& p) { return Eigen::Vector3d(0, 0, p.z() > 31 ? 1 : -1); }, 1.0, 0.0,
          0.25};
}

}  // namespace skinframe::test
