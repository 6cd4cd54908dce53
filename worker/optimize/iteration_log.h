// SPDX-License-Identifier: GPL-3.0-or-later
// One line an iteration, for people who want to see why a program takes long.
//
//   iter   objective      primal    dual      compl     lg(mu)  lg(reg)  step p   step d   halvings  factors
//     12   1.0423311e+03  3.1e-05   8.8e-04   1.0e-02    -2.0      -      0.9931   1.0000      0        1
#pragma once

#include <string>

#include "worker/optimize/iterate.h"

namespace skinframe {

struct IterationRecord {
  int iteration = 0;
  double barrier = 0;
  double objective = 0;
  double volume = 0;  // nondimensional
  KktError error;     // at mu = 0
  // Of the step that led here; zero at the first iterate.
  double regularisation = 0;
  double primal_length = 0, dual_length = 0;
  int halvings = 0;
  int factorisations = 0;
};

std::string iteration_log_header();
std::string iteration_log_line(const IterationRecord& record);

}  // namespace skinframe
