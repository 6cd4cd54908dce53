// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/job/run_job.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <new>

#include "worker/job/checkpoint_file.h"
#include "worker/job/event_stream.h"
#include "worker/job/read_job.h"
#include "worker/job/run_frame_job.h"
#include "worker/pipeline/pipeline.h"
#include "worker/pipeline/write_json.h"
#include "worker/run/reserve_blas.h"
#include "worker/run/stop_signals.h"

namespace skinframe {
namespace {

using nlohmann::json;

// One printer: its own ending. Several: SUCCEEDED when all are done, PARTIAL when some are, else the first
// one's reason.
json outcome_of(const std::vector<PrinterOutcome>& printers) {
  const auto done =
      std::count_if(printers.begin(), printers.end(), [](const auto& p) { return p.succeeded(); });
  json out = {{"state", done > 0 ? "SUCCEEDED" : "FAILED"}, {"printers", json::array()}};
  const auto first_failed =
      std::find_if(printers.begin(), printers.end(), [](const auto& p) { return !p.succeeded(); });
  if (first_failed == printers.end()) {
    out["reason"] = to_string(Reason::kNone);
    out["detail"] = "";
  } else {
    out["reason"] = to_string(done > 0 ? Reason::kPartial : first_failed->reason);
    out["detail"] = first_failed->printer + ": " + first_failed->detail;
  }
  for (const PrinterOutcome& printer : printers) out["printers"].push_back(outcome_json(printer));
  return out;
}

json work(const JobFile& file, const std::filesystem::path& work_dir, std::stop_token stop) {
  const auto out_dir = work_dir / "out";
  RunContext context;
  context.stop = stop;
  context.seed = file.request.options.seed;
  context.threads = file.threads;
  EventStream events(stdout, file.frame_problem ? TimeLeft::kUnknown : TimeLeft::kEstimated);
  CheckpointFile checkpoints(work_dir, file.request.job_id, events);
  PipelineObserver observer;
  observer.checkpoints = &checkpoints;
  observer.progress = [&](const PipelineProgress& progress) { events.progress(progress); };
  observer.printer_ended = [&](const PrinterOutcome& outcome) { events.printer_ended(outcome); };
  if (!reserve_blas_buffers(file.threads)) {
    return failed_outcome(
        Reason::kOutOfMemory,
        "the job may take less memory than the solver needs for itself (--memory-limit-mb)");
  }
  try {
    if (file.frame_problem) return run_frame_job(file, out_dir, events, &checkpoints, context);
    auto outcomes = run_pipeline(file.request, out_dir, observer, context);
    if (!outcomes) return failed_outcome(reason_of(outcomes.error().kind), outcomes.error().message);
    return outcome_of(*outcomes);
  } catch (const std::bad_alloc&) {
    return failed_outcome(
        Reason::kOutOfMemory,
        file.frame_problem
            ? "the job needed more memory than it may take; use a smaller frame"
            : "the job needed more memory than it may take; use fewer nodes or a larger --voxel");
  } catch (const std::exception& error) {
    return failed_outcome(Reason::kInternal, std::string("unexpected: ") + error.what());
  }
}

}  // namespace

int run_job(const std::filesystem::path& work_dir) {
  const StopOnSignal stop;
  json outcome;
  auto file = read_job(work_dir / "job.json");
  if (!file) {
    outcome = failed_outcome(reason_of(file.error().kind), file.error().message);
  } else {
    if (file->frame_problem) {
      spdlog::info("job={} frame problem={}", file->request.job_id, file->request.mesh_name);
    } else {
      spdlog::info("job={} mesh={} printers={}", file->request.job_id, file->request.mesh_name,
                   file->request.printers.size());
    }
    outcome = work(*file, work_dir, stop.token());
    spdlog::info("job={} ended state={} reason={}", file->request.job_id, outcome["state"].get<std::string>(),
                 outcome["reason"].get<std::string>());
  }
  if (auto written = write_json(work_dir / "outcome.json", outcome); !written) {
    spdlog::error("{}", written.error().message);
    return 1;
  }
  return 0;
}

}  // namespace skinframe
