// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/pipeline/pipeline.h"

#include "worker/pipeline/prepare_solid.h"
#include "worker/pipeline/run_printers.h"
#include "worker/pipeline/write_json.h"
#include "worker/run/one_blas_thread.h"

namespace skinframe {

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
  auto reports = run_printers(*prepared, request, out_dir, observer, context);
  if (!reports) return reports.error();
  for (const PrinterReport& part : *reports) {
    report["printers"].push_back(to_json(part));
    outcomes.push_back(outcome_of(part));
  }
  if (auto written = write_json(out_dir / "report.json", report); !written) return written.error();
  return outcomes;
}

}  // namespace skinframe
