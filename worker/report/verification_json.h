// SPDX-License-Identifier: GPL-3.0-or-later
// The "verification" object of report.json: the valid model's figures ("verified"), and the comparison.
// Without an answer of that model: {"label": "not verified", "reason": ...}, and no figure.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "worker/verify/verification.h"

namespace skinframe {

nlohmann::json to_json(const Verification& verification);
nlohmann::json not_verified_json(const std::string& reason);

// What the table of a job shows of it: the wire's "verified" object.
nlohmann::json verified_summary_json(const Verification& verification);

}  // namespace skinframe
