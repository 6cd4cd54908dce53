// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/job/run_job.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <new>
#include <thread>

#include "worker/job/event_stream.h"
#include "worker/job/read_job.h"
#include "worker/pipeline/pipeline.h"
#include "worker/pipeline/write_json.h"
#include "worker/run/stop_signals.h"

namespace skinframe {
namespace {

using nlohmann::json;

json failed(Reason reason, const std::string& detail) {
  return {{"state", reason == Reason::kCancelled ? "CANCELLED" : "FAILED"},
          {"reason", to_string(reason)},
          {"detail", detail},
          {"printers", json::array()}};
}

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

json work(const JobFile& file, const std::filesystem::path& out_dir, std::stop_token stop) {
  RunContext context;
  context.stop = stop;
  context.seed = file.request.options.seed;
  context.threads = file.threads;
  EventStream events(stdout);
  PipelineObserver observer;
  observer.progress = [&](const PipelineProgress& progress) { events.progress(progress); };
  observer.printer_ended = [&](const PrinterOutcome& outcome) { events.printer_ended(outcome); };
  try {
    auto outcomes = run_pipeline(file.request, out_dir, observer, context);
    if (!outcomes) return failed(reason_of(outcomes.error().kind), outcomes.error().message);
    return outcome_of(*outcomes);
  } catch (const std::bad_alloc&) {
    return failed(Reason::kOutOfMemory,
                  "the job needed more memory than it may take; use fewer nodes or a larger --voxel");
  } catch (const std::exception& error) {
    return failed(Reason::kInternal, std::string("unexpected: ") + error.what());
  }
}

}  // namespace

int run_job(const std::filesystem::path& work_dir) {
  StopSignals signals;
  std::stop_source stop;
  const std::jthread listener([&](std::stop_token done) {
    while (!done.stop_requested())
      if (signals.came_within(std::chrono::milliseconds(50))) stop.request_stop();
  });

  json outcome;
  auto file = read_job(work_dir / "job.json");
  if (!file) {
    outcome = failed(reason_of(file.error().kind), file.error().message);
  } else {
    spdlog::info("job={} mesh={} printers={}", file->request.job_id, file->request.mesh_name,
                 file->request.printers.size());
    outcome = work(*file, work_dir / "out", stop.get_token());
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
