// SPDX-License-Identifier: GPL-3.0-or-later
// "orientation" of report.json's mesh.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "worker/check/exported.h"

namespace skinframe::check {

// None where the report tells of no choice. Throws what nlohmann::json throws.
std::optional<ExportedOrientation> parse_orientation(const nlohmann::json& mesh);

}  // namespace skinframe::check
