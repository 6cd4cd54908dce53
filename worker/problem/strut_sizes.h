// SPDX-License-Identifier: GPL-3.0-or-later
// Radii and lengths of the struts before and after each stage, the paper's figure 5: "strut_sizes" of
// frame.json and of result.json,
//
//   {"initial" | "size" | "topology": {"radii_mm": [..], "lengths_mm": [..]}}
//
// one number a strut, to nine digits. Initial and size are of the struts that the optimiser was given, in
// their order, initial at the lower bounds of the radii. After the geometry stage they are those of the
// file's own "struts".
#pragma once

#include <nlohmann/json.hpp>

#include "worker/optimize/optimize_frame.h"

namespace skinframe {

inline constexpr const char* kStrutSizes = "strut_sizes";

nlohmann::json strut_sizes_json(const OptimizeResult& result);

}  // namespace skinframe
