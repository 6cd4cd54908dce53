// SPDX-License-Identifier: GPL-3.0-or-later
// All printers of one job on one prepared solid, side by side as far as the job's threads go: each printer
// gets its share of them. One that runs out of memory beside others is tried again alone.
//
// Guarantees:
//  1. One report a printer, in the request's order, and the same at any thread count.
//  2. A printer that is refused or fails does not sink the others; its report says why.
//  3. Printers whose skins are equally thick share one.
//  4. The observer's functions are called one at a time; printer_ended as each printer ends.
#pragma once

#include <filesystem>
#include <vector>

#include "worker/pipeline/pipeline.h"
#include "worker/pipeline/prepare_solid.h"

namespace skinframe {

// Errors: kIo and kCancelled, which end the whole job.
Result<std::vector<PrinterReport>> run_printers(const PreparedSolid& prepared, const JobRequest& request,
                                                const std::filesystem::path& out_dir,
                                                const PipelineObserver& observer, const RunContext& context);

PrinterOutcome outcome_of(const PrinterReport& report);

}  // namespace skinframe
