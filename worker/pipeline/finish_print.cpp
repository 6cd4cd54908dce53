// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/pipeline/finish_print.h"

#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <optional>
#include <stop_token>

#include "worker/pipeline/support_print.h"
#include "worker/pipeline/verify_result.h"
#include "worker/pipeline/write_results.h"

namespace skinframe {
namespace {

Status write_files(const MergedPrint& print, const PreparedSolid& prepared, const Skin& skin,
                   const PrinterRequest& printer, const std::filesystem::path& folder, PrinterReport* report,
                   const RunContext& context) {
  if (auto written = write_printable(print, prepared, printer, folder, report, context); !written)
    return written;
  if (!report->supports) return ok_status();
  return write_supports(report->optimised->problem.frame, skin, printer, folder, report);
}

}  // namespace

Status finish_print(const MergedPrint& print, const PreparedSolid& prepared, const Skin& skin,
                    const PrinterRequest& printer, const JobRequest& job, const std::filesystem::path& folder,
                    Laps& laps, PrinterReport* report, const RunContext& context) {
  if (!job.options.verify) {
    auto written = write_files(print, prepared, skin, printer, folder, report, context);
    laps.lap("write");
    return written;
  }
  context.report({.stage = Stage::kVerify, .frame_volume_mm3 = report->statistics.frame_volume_mm3});
  const OptimizeResult& result = *report->optimised;  // stays as it is while the report grows
  std::stop_source stop;                              // with the job, and when the disk fails
  const std::stop_callback forward(context.stop, [&stop] { stop.request_stop(); });
  RunContext stopping = context;
  stopping.stop = stop.get_token();
  std::optional<Result<Verification>> verified;
  std::optional<Status> written;
  tbb::task_arena arena(std::max(1, context.threads));
  arena.execute([&] {
    tbb::task_group beside;
    beside.run([&] { verified = verify_result(prepared, skin, job, result, print.volume_mm3(), stopping); });
    written = write_files(print, prepared, skin, printer, folder, report, context);
    if (!*written) stop.request_stop();
    laps.lap("write");
    beside.wait();
  });
  if (!*written) return *written;
  auto reported = report_verification(std::move(*verified), folder, report);
  laps.lap("verify");
  return reported;
}

}  // namespace skinframe
