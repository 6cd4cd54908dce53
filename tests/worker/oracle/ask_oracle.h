// SPDX-License-Identifier: GPL-3.0-or-later
// SizeOpt by the oracle (tests/oracle): a program of its own, asked through a problem file.
#pragma once

#include <string>
#include <vector>

#include "worker/mechanics/frame_problem.h"

namespace skinframe::testing {

struct OracleAnswer {
  std::string status;  // "optimal" when it served
  double volume_mm3 = 0;
  std::vector<double> areas_mm2;
  int iterations = 0, factorisations = 0;
};

// `every_strain`: strain limits that the displacement limit implies are not left out.
OracleAnswer ask_oracle(const FrameProblem& problem, bool every_strain = false);

}  // namespace skinframe::testing
