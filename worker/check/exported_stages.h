// SPDX-License-Identifier: GPL-3.0-or-later
// "strut_sizes" of frame.json and result.json, beside what the report says of them.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "worker/check/exported.h"

namespace skinframe::check {

// Empty where the file has none. Throws nlohmann's exceptions where it is not what it has to be.
std::vector<ExportedStage> parse_stages(const nlohmann::json& frame, const nlohmann::json& counts);

// Gives the stages the volumes that the report has for them.
void report_volumes(ExportedPrinter* out, std::optional<double> initial_mm3);

}  // namespace skinframe::check
