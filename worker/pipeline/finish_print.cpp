// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/pipeline/finish_print.h"

#include <optional>

#include "worker/pipeline/side_by_side.h"
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
  std::optional<Result<Verification>> verified;
  const Status written = side_by_side(
      [&](const RunContext& stopping) {
        Status files = write_files(print, prepared, skin, printer, folder, report, stopping);
        laps.lap("write");
        return files;
      },
      [&](const RunContext& stopping) {
        verified = verify_result(prepared, skin, job, result, print.volume_mm3(), stopping);
        return ok_status();  // a model without an answer is told, and the files stay
      },
      context);
  if (!written) return written;
  auto reported = report_verification(std::move(*verified), folder, report);
  laps.lap("verify");
  return reported;
}

}  // namespace skinframe
