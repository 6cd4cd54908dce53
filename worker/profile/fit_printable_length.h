// SPDX-License-Identifier: GPL-3.0-or-later
// p(theta) of section 4.5 from printed test struts: the nearest curve, in the sense of least squares, that
// never rises with the angle.
//
//   minimise  sum_i (p(theta_i) - length_i)^2   over   p(theta_k) = b + sum_{m >= k} s_m,   b >= 0.001 mm, s_m >= 0
//
// with one knot at each measured angle (at most kMostKnots, spread over them evenly by count) and straight
// lines between. The problem is convex: its minimum does not depend on where the search starts. With a knot
// at each angle it is isotonic regression.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "worker/profile/printable_length.h"
#include "worker/run/result.h"

namespace skinframe {

// One test strut that printed, the longest of its angle.
struct CalibrationPoint {
  double angle_deg = 0;  // from the vertical
  double length_mm = 0;
  int line = 0;  // of the file
};

// A text with the header `angle_deg,length_mm` and a line a strut; empty lines and those with # are skipped.
// kInvalidInput: FILE:LINE and what is wrong; fewer than two angles; more than 10,000 struts.
Result<std::vector<CalibrationPoint>> read_calibration(const std::filesystem::path& file);

struct CalibrationFit {
  std::vector<PrintableLength::Point> points;  // the knots; lengths rounded down to 0.001 mm
  std::vector<double> fitted_mm;               // p at each measured angle, in the order of the input
  double rms_mm = 0;                           // of measured - fitted
  double largest_mm = 0;                       // its largest magnitude

  double steepest_deg() const { return points.front().angle_deg; }
  double flattest_deg() const { return points.back().angle_deg; }
  // Of a curve that ends before 90 degrees a profile could not say what flatter struts do.
  bool reaches_flat() const { return flattest_deg() == 90; }
};

constexpr int kMostKnots = PrintableLength::kMostPoints;

// kInternal: where the solver ended the conditions of a minimum do not hold.
Result<CalibrationFit> fit_printable_length(const std::vector<CalibrationPoint>& points);

}  // namespace skinframe
