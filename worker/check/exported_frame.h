// SPDX-License-Identifier: GPL-3.0-or-later
// A frame and the proofs of its bounds out of frame.json, initial-frame.json, result.json.
//
// Throw nlohmann's exceptions where the file is not what it has to be, and std::out_of_range with the place
// of an index that names nothing.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "worker/check/exported.h"

namespace skinframe::check {

// A problem file has no radii yet.
enum class Radii { kGiven, kNone };

ExportedFrame parse_frame(const nlohmann::json& file, Radii radii = Radii::kGiven);

// Nothing where the file has no proof under that key.
std::optional<ExportedProof> parse_proof(const nlohmann::json& file, const char* key,
                                         const ExportedFrame& frame);

}  // namespace skinframe::check
