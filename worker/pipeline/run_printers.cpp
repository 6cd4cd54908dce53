// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/pipeline/run_printers.h"

#include <algorithm>
#include <atomic>
#include <future>
#include <mutex>
#include <new>
#include <optional>
#include <stop_token>

#include "worker/pipeline/fits_tray.h"
#include "worker/pipeline/make_skin_frame.h"

namespace skinframe {
namespace {

PrinterReport refused(const PrinterRequest& printer, Reason reason, const std::string& detail) {
  PrinterReport report;
  report.printer = printer.printer.id;
  report.material = printer.material.id;
  report.reason = reason;
  report.detail = detail;
  return report;
}

bool ends_the_job(const Error& error) {
  return error.kind == ErrorKind::kCancelled || error.kind == ErrorKind::kIo;
}

class PrinterRun {
 public:
  PrinterRun(const PreparedSolid& prepared, const JobRequest& request, const std::filesystem::path& out_dir,
             const PipelineObserver& observer, const RunContext& context)
      : prepared_(prepared),
        request_(request),
        out_dir_(out_dir),
        observer_(observer),
        context_(context),
        forward_stop_(context.stop, [this] { stop_.request_stop(); }),
        reports_(request.printers.size()) {
    for (const PrinterRequest& printer : request.printers)  // the others will not ask
      if (fits_tray(prepared.solid, printer.printer)) skins_.announce(printer.printer.skin_thickness_mm());
    told_.checkpoints = observer.checkpoints;
    told_.progress = [this](const PipelineProgress& progress) {
      const std::scoped_lock lock(observer_mutex_);
      observer_.progress(progress);
    };
  }

  Result<std::vector<PrinterReport>> run() {
    const std::size_t count = request_.printers.size();
    const auto lanes = std::min<std::size_t>(count, static_cast<std::size_t>(std::max(1, context_.threads)));
    std::vector<std::future<void>> others;
    for (std::size_t lane = 1; lane < lanes; ++lane)
      others.push_back(std::async(std::launch::async, [this, lanes] { take_printers(lanes); }));
    take_printers(lanes);
    for (auto& lane : others) lane.get();
    if (lanes > 1)  // what had no room beside another may have it alone
      for (std::size_t i = 0; i < count && !error_; ++i)
        if (reports_[i] && reports_[i]->reason == Reason::kOutOfMemory) make(i, 1);
    if (error_) return *error_;
    std::vector<PrinterReport> reports;
    for (auto& report : reports_) {
      if (!report) return cancelled_error();  // stopped before its turn
      reports.push_back(std::move(*report));
    }
    return reports;
  }

 private:
  void take_printers(std::size_t lanes) {
    for (std::size_t i = next_++; i < request_.printers.size() && !stop_.stop_requested(); i = next_++)
      make(i, lanes);
  }

  void make(std::size_t i, std::size_t lanes) {
    const PrinterRequest& printer = request_.printers[i];
    RunContext context = context_;
    context.stop = stop_.get_token();
    context.threads = std::max(1, context_.threads / static_cast<int>(lanes));
    const auto keep = [&](PrinterReport report) {
      const bool again = report.reason == Reason::kOutOfMemory && lanes > 1;
      reports_[i] = std::move(report);
      if (!again) tell_end(*reports_[i]);
    };
    try {
      auto made = make_skin_frame(prepared_, skins_, printer, request_, out_dir_, told_, context);
      if (made) {
        keep(std::move(made).value());
      } else if (ends_the_job(made.error())) {
        fail(made.error());
      } else {
        keep(refused(printer, reason_of(made.error().kind), made.error().message));
      }
    } catch (const std::bad_alloc&) {
      keep(refused(printer, Reason::kOutOfMemory,
                   "more memory was needed than the job may take; use fewer nodes or a larger --voxel"));
    } catch (...) {
      stop_.request_stop();  // the job ends with it: the others need not go on
      throw;
    }
  }

  // The first error of its kind counts: what follows it is the others being stopped.
  void fail(const Error& error) {
    const std::scoped_lock lock(observer_mutex_);
    if (!error_) error_ = error;
    stop_.request_stop();
  }

  void tell_end(const PrinterReport& report) {
    const std::scoped_lock lock(observer_mutex_);
    observer_.printer_ended(outcome_of(report));
  }

  const PreparedSolid& prepared_;
  const JobRequest& request_;
  const std::filesystem::path& out_dir_;
  const PipelineObserver& observer_;
  const RunContext& context_;
  PipelineObserver told_;
  SharedSkins skins_;
  std::mutex observer_mutex_;
  std::stop_source stop_;
  std::stop_callback<std::function<void()>> forward_stop_;
  std::atomic<std::size_t> next_ = 0;
  std::vector<std::optional<PrinterReport>> reports_;
  std::optional<Error> error_;
};

}  // namespace

PrinterOutcome outcome_of(const PrinterReport& report) {
  PrinterOutcome outcome{report.printer, report.material, report.reason,
                         report.detail,  std::nullopt,    std::nullopt};
  if (report.optimised)
    outcome.best_reachable_displacement_mm = report.optimised->best_reachable_displacement_mm;
  if (outcome.succeeded()) outcome.statistics = report.statistics;
  return outcome;
}

Result<std::vector<PrinterReport>> run_printers(const PreparedSolid& prepared, const JobRequest& request,
                                                const std::filesystem::path& out_dir,
                                                const PipelineObserver& observer, const RunContext& context) {
  return PrinterRun(prepared, request, out_dir, observer, context).run();
}

}  // namespace skinframe
