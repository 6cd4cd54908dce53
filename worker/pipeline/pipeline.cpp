// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/pipeline/pipeline.h"

#include <fmt/format.h>

#include <new>

#include "worker/pipeline/make_skin_frame.h"
#include "worker/pipeline/prepare_solid.h"
#include "worker/pipeline/write_json.h"
#include "worker/run/one_blas_thread.h"

namespace skinframe {
namespace {

PrinterOutcome outcome_of(const PrinterReport& report) {
  PrinterOutcome outcome{report.printer, report.material, report.reason,
                         report.detail,  std::nullopt,    std::nullopt};
  if (report.optimised)
    outcome.best_reachable_displacement_mm = report.optimised->best_reachable_displacement_mm;
  if (outcome.succeeded()) outcome.statistics = report.statistics;
  return outcome;
}

// A printer that needs more memory than there is ends so, and its memory is free for the next one.
Result<PrinterReport> make_or_run_out(const PreparedSolid& prepared, const PrinterRequest& printer,
                                      const JobRequest& request, const std::filesystem::path& out_dir,
                                      const PipelineObserver& observer, const RunContext& context) {
  try {
    return make_skin_frame(prepared, printer, request, out_dir, observer, context);
  } catch (const std::bad_alloc&) {
    PrinterReport report;
    report.printer = printer.printer.id;
    report.material = printer.material.id;
    report.reason = Reason::kOutOfMemory;
    report.detail = "more memory was needed than the job may take; use fewer nodes or a larger --voxel";
    return report;
  }
}

}  // namespace

Result<std::vector<PrinterOutcome>> run_pipeline(const JobRequest& request,
                                                 const std::filesystem::path& out_dir,
                                                 const PipelineObserver& observer, const RunContext& shared) {
  use_one_blas_thread();
  RunContext context = shared;
  context.report = [&](const Progress& progress) { observer.progress({"", progress, {}, {}}); };
  auto prepared = prepare_solid(request, context);
  if (!prepared) return prepared.error();

  nlohmann::json report = {{"job_id", request.job_id},
                           {"version", SKINFRAME_VERSION},
                           {"mesh", mesh_json(prepared->facts, prepared->solid, prepared->contact)},
                           {"printers", nlohmann::json::array()}};
  std::vector<PrinterOutcome> outcomes;
  for (const PrinterRequest& printer : request.printers) {
    auto made = make_or_run_out(*prepared, printer, request, out_dir, observer, context);
    if (!made && made.error().kind == ErrorKind::kCancelled) return made.error();
    if (!made && made.error().kind == ErrorKind::kIo) return made.error();
    PrinterReport part;
    if (made) {
      part = std::move(made).value();
    } else {
      part.printer = printer.printer.id;
      part.material = printer.material.id;
      part.reason = reason_of(made.error().kind);
      part.detail = made.error().message;
    }
    report["printers"].push_back(to_json(part));
    outcomes.push_back(outcome_of(part));
    observer.printer_ended(outcomes.back());
  }
  if (auto written = write_json(out_dir / "report.json", report); !written) return written.error();
  return outcomes;
}

}  // namespace skinframe
