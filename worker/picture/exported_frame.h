// SPDX-License-Identifier: GPL-3.0-or-later
// What frame.json (or a frame job's result.json) shows: struts as segments with radii, supports, and the
// sizes of the struts at each stage.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "worker/run/result.h"

namespace skinframe::picture {

struct DrawnStrut {
  Eigen::Vector3d a_mm, b_mm;
  double radius_mm = 0;
};

// One radius and one length a strut.
struct StageSizes {
  std::string name;  // for people: "initial", "after sizing", ...
  std::vector<double> radii_mm, lengths_mm;
};

struct DrawnFrame {
  std::vector<DrawnStrut> struts;    // at least one
  std::vector<DrawnStrut> supports;  // of extrusion printers
  std::vector<StageSizes>
      stages;  // in order, the last is of `struts`; that one alone in files without others
};

// A file with more, or with coordinates further out, is refused.
inline constexpr std::size_t kMostStruts = 1'000'000;
inline constexpr double kFurthestMm = 1e6;

// Errors: kIo and kInvalidInput, naming the file and the element.
Result<DrawnFrame> read_frame(const std::filesystem::path& path);

}  // namespace skinframe::picture
