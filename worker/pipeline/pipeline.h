// SPDX-License-Identifier: GPL-3.0-or-later
// The whole way of a job, the paper's overview figure (Wang et al. 2013, figure 2) as one function:
//
//   read -> place -> repair -> for each printer, side by side where the job has threads:
//     skin -> sample -> pose -> optimise -> merge -> write
//
// Guarantees:
//  1. out_dir holds report.json and a folder for each printer with a result, and nothing else.
//  2. A printer that is refused or fails does not sink the others; its outcome says why.
//  3. Every figure in report.json is of what was written, or is named nominal.
//  4. The context's own report is not called: progress goes to the observer.
//
// Example: run_pipeline(request, "out", PipelineObserver{}, context)
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "worker/pipeline/request.h"
#include "worker/report/report.h"
#include "worker/run/checkpoints.h"
#include "worker/run/run_context.h"

namespace skinframe {

struct PrinterOutcome {
  std::string printer, material;
  Reason reason = Reason::kNone;
  std::string detail;  // one sentence for the user
  std::optional<double> best_reachable_displacement_mm;
  std::optional<Statistics> statistics;  // when it succeeded
  bool succeeded() const { return reason == Reason::kNone; }
};

// A tick of progress about one printer; volumes are known once the skin is built. Nominal.
struct PipelineProgress {
  std::string printer;  // empty while all printers share the stage
  Progress progress;
  std::optional<double> skin_volume_mm3, solid_volume_mm3;
};

struct PipelineObserver {
  std::function<void(const PipelineProgress&)> progress = [](const PipelineProgress&) {};
  std::function<void(const PrinterOutcome&)> printer_ended = [](const PrinterOutcome&) {};
  Checkpoints* checkpoints = nullptr;  // none: every stage begins at its beginning
};

// One outcome a printer, in the request's order. Errors: what concerns all printers alike (the mesh, the
// disk), and cancellation.
Result<std::vector<PrinterOutcome>> run_pipeline(const JobRequest& request,
                                                 const std::filesystem::path& out_dir,
                                                 const PipelineObserver& observer, const RunContext& shared);

}  // namespace skinframe
