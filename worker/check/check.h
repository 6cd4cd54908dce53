// SPDX-License-Identifier: GPL-3.0-or-later
// `skinframe check DIR`: re-reads only the exported files and judges every claim with code of its own. It
// shares no code with the stages that made them beyond the mesh reader, so that an error there is not
// repeated here.
//
// The result of a frame problem is judged as far as it goes: radii, volumes, equilibrium, limits, balance.
//
// A result that ended INFEASIBLE makes claims too: that its best frame is in equilibrium, and what it
// reaches.
#pragma once

#include <filesystem>
#include <vector>

#include "worker/check/claim.h"
#include "worker/run/run_context.h"

namespace skinframe::check {

// One verdict a printer, or one of the frame. Errors: a file that is absent or cannot be read, named.
Result<std::vector<Verdict>> check_directory(const std::filesystem::path& directory, RunContext& context);

// For people: a line a claim, yes or NO first.
std::string to_text(const std::vector<Verdict>& verdicts);
// {"holds", "printers": [{"printer", "holds", "claims": [{"claim", "holds", "measured"}], "notes": [...]}]}
std::string to_json_text(const std::vector<Verdict>& verdicts);

}  // namespace skinframe::check
