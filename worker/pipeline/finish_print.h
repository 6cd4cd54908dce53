// SPDX-License-Identifier: GPL-3.0-or-later
// The last two stages of a printer's part: its files, and what the valid model says of what they hold.
#pragma once

#include <filesystem>

#include "worker/pipeline/laps.h"
#include "worker/pipeline/prepare_solid.h"
#include "worker/pipeline/solve_and_merge.h"
#include "worker/report/report.h"
#include "worker/run/run_context.h"

namespace skinframe {

// Both begin at once, where the job has two threads for them: neither needs the other, and verification runs
// on one thread alone. What comes of them is the same at any number of threads. Seconds: those of "verify"
// are what it took beyond "write". Errors: the disk, which stops the verification; cancellation.
Status finish_print(const MergedPrint& print, const PreparedSolid& prepared, const Skin& skin,
                    const PrinterRequest& printer, const JobRequest& job, const std::filesystem::path& folder,
                    Laps& laps, PrinterReport* report, const RunContext& context);

}  // namespace skinframe
