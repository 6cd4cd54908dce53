// SPDX-License-Identifier: GPL-3.0-or-later
// p(theta) of section 4.5: the longest strut that a printer makes without support, by the strut's angle to
// the vertical. 0 stands upright, 90 degrees (pi / 2) lies flat.
//
// Between two measured points the length is the straight line through them. No measured length, no promise:
// - steeper than the first point: the first point's length (a steeper strut prints at least as far);
// - a point without length has no limit, nor has anything steeper; between it and the next point the next
//   point's length holds (the shorter of the two);
// - flatter than the last point nothing would be known, so that a curve has to reach 90 degrees.
// Guarantees: 1. defined for every angle; 2. > 0; 3. never rises with the angle.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "worker/run/result.h"

namespace skinframe {

class PrintableLength {
 public:
  struct Point {
    double angle_deg = 0;             // from the vertical, 0 .. 90
    std::optional<double> length_mm;  // > 0; none: no limit
  };
  static constexpr int kMostPoints = 64;

  // kInvalidInput names the point: angles do not rise, lengths rise, a length is not > 0, the last angle is
  // not 90, there are none or more than kMostPoints.
  static Result<PrintableLength> make(std::vector<Point> points, bool is_default, std::string source);

  // Longest printable length in mm, infinity where there is no limit. The angle is that of the undirected
  // strut: 0 .. pi / 2; rounding beyond either end counts as the end.
  double length_mm(double angle_from_vertical_rad) const;

  const std::vector<Point>& points() const { return points_; }
  bool is_default() const { return is_default_; }        // an assumption, not measured on the printer
  const std::string& source() const { return source_; }  // what the points rest on, for people

 private:
  PrintableLength(std::vector<Point> points, bool is_default, std::string source);

  std::vector<Point> points_;
  bool is_default_ = false;
  std::string source_;
};

}  // namespace skinframe
