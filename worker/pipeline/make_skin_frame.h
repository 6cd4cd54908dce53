// SPDX-License-Identifier: GPL-3.0-or-later
// One printer's part of a job: from the closed solid to the files in out_dir/PRINTER.
#pragma once

#include "worker/pipeline/pipeline.h"
#include "worker/pipeline/prepare_solid.h"
#include "worker/pipeline/shared_skins.h"

namespace skinframe {

// A report for every ending that is one of the work (done, infeasible); what was written, it tells. With
// kInfeasible the folder holds frame.json, the best frame that was found, and initial-frame.json, but no
// mesh. Errors: what could not be tried.
Result<PrinterReport> make_skin_frame(const PreparedSolid& prepared, SharedSkins& skins,
                                      const PrinterRequest& printer, const JobRequest& request,
                                      const std::filesystem::path& out_dir, const PipelineObserver& observer,
                                      const RunContext& shared);

}  // namespace skinframe
