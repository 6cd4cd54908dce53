// SPDX-License-Identifier: GPL-3.0-or-later
// The last stage of a printer's part: what its frame does under the job's loads by the valid model, beside
// the paper's figures.
#pragma once

#include "worker/pipeline/prepare_solid.h"
#include "worker/report/report.h"
#include "worker/run/run_context.h"

namespace skinframe {

// By the valid model, of what has been merged; touches neither the disk nor the report. Errors: where that
// model has no answer; kCancelled.
Result<Verification> verify_result(const PreparedSolid& prepared, const Skin& skin, const JobRequest& job,
                                   const OptimizeResult& result, double printed_volume_mm3,
                                   const RunContext& context);

// Fills report.verification and writes a deformation-NAME.ply for each load case, and pinch.ply; where the
// model had no answer, statistics.not_verified and a warning say why, and the job goes on. Errors: the disk,
// cancellation.
Status report_verification(Result<Verification> verified, const std::filesystem::path& folder,
                           PrinterReport* report);

}  // namespace skinframe
