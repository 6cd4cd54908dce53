// SPDX-License-Identifier: GPL-3.0-or-later
// The result of a frame problem in figures: result_json() (see result_file.h) without what has one entry a
// node, a strut or a load case. What `solve-frame --json` prints and what report.json of a frame job holds.
#pragma once

#include <nlohmann/json.hpp>

namespace skinframe {

nlohmann::json result_summary(const nlohmann::json& result);

}  // namespace skinframe
