// SPDX-License-Identifier: GPL-3.0-or-later
// The support struts of a result, from frame.json and report.json.
#pragma once

#include <nlohmann/json.hpp>

#include "worker/check/exported.h"

namespace skinframe::check {

// Throws what nlohmann::json throws, and std::out_of_range with the place of an index that names nothing.
ExportedSupports parse_supports(const nlohmann::json& in_frame, const nlohmann::json& in_report,
                                std::size_t frame_nodes, std::size_t frame_struts);

}  // namespace skinframe::check
