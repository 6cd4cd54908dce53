// SPDX-License-Identifier: GPL-3.0-or-later
#include "worker/pipeline/make_skin_frame.h"

#include <fmt/format.h>

#include <algorithm>

#include "worker/pipeline/earlier_frame.h"
#include "worker/pipeline/finish_print.h"
#include "worker/pipeline/fits_tray.h"
#include "worker/pipeline/initial_frame.h"
#include "worker/pipeline/make_solid.h"
#include "worker/pipeline/pose_problem.h"
#include "worker/pipeline/sample_by_stress.h"
#include "worker/pipeline/sampling_checkpoint.h"
#include "worker/pipeline/solve_and_merge.h"
#include "worker/pipeline/support_print.h"
#include "worker/pipeline/write_json.h"
#include "worker/problem/problem_file.h"
#include "worker/problem/proof_json.h"
#include "worker/problem/strut_sizes.h"

namespace skinframe {
namespace {

std::vector<std::string> honest_warnings(const PrinterProfile& printer) {
  switch (printer.process) {
    case PrintProcess::kExtrusion: {
      std::vector<std::string> warnings;
      if (printer.drain_holes)
        warnings.push_back("the profile's drain holes are not made: there is nothing to drain in extrusion");
      if (!printer.printable_length)
        warnings.push_back(
            "the printer's profile says nothing about the length that prints without support, so no support "
            "struts are made: struts that overhang need the slicer's own supports");
      return warnings;
    }
    case PrintProcess::kPowder:
    case PrintProcess::kResin:
      if (printer.drain_holes) return {};
      return {
          "the printer's profile asks for no drain holes, so none are made: what fills the cavity while "
          "printing stays inside"};
  }
  return {};
}

// Frames with other holes do not serve.
std::string rule_key(const PrinterProfile& printer) {
  const auto rule = printer.holes_to_make();
  if (!rule) return {};
  return fmt::format("-{}-{}-{}", rule->diameter_mm, rule->least_count, rule->least_diameter_mm);
}

PrinterReport begin_report(const PrinterRequest& request) {
  PrinterReport report;
  report.printer = request.printer.id;
  report.material = request.material.id;
  report.min_radius_mm = request.printer.min_radius_mm;
  report.skin_thickness_mm = request.printer.skin_thickness_mm();
  report.max_internal_radius_mm = request.printer.max_internal_radius_mm;
  report.density_g_cm3 = request.material.density_g_cm3;
  report.tray_mm = request.printer.tray_mm;
  report.price_per_kg = request.price_per_kg;
  report.warnings = honest_warnings(request.printer);
  return report;
}

void report_smoothing(const Smoothing& smoothing, PrinterReport* report) {
  report->smoothing = SmoothingFacts{smoothing.applied, smoothing.detail, smoothing.added_skin_mm3};
  if (smoothing.applied)
    report->warnings.push_back(fmt::format(
        "detail finer than the skin is smoothed away below it: {:.1f} % of the surface stands further "
        "than {:.2g} mm from its smooth copy, and {:.0f} mm3 more are printed as skin (see "
        "--smooth)",
        100 * smoothing.detail.share, kDetailHeightInThicknesses * report->skin_thickness_mm,
        smoothing.added_skin_mm3));
}

// What sampling would tell, of the frame that is taken over.
Result<SampledFrame> sample_again(const InitialFrame& earlier, PrinterReport* report) {
  const SampledFrame& sampled = earlier.sampled;
  report->warnings.insert(report->warnings.end(), sampled.warnings.begin(), sampled.warnings.end());
  report->sampling = sampling_facts(sampled, earlier.density);
  return sampled;
}

}  // namespace

Result<PrinterReport> make_skin_frame(const PreparedSolid& prepared, SharedSkins& skins,
                                      const PrinterRequest& request, const JobRequest& job,
                                      const std::filesystem::path& out_dir, const PipelineObserver& observer,
                                      const RunContext& shared) {
  const PrinterProfile& printer = request.printer;
  if (auto fits = fits_tray(prepared.solid, printer); !fits) return fits.error();
  PrinterReport report = begin_report(request);
  std::optional<double> skin_volume_mm3;
  RunContext context = shared;
  context.report = [&](const Progress& progress) {
    observer.progress({printer.id, progress, skin_volume_mm3, prepared.solid.volume_mm3()});
  };
  Laps laps(&report.seconds);

  context.report({.stage = Stage::kSkin});
  SkinOptions skin_options;
  skin_options.thickness_mm = printer.skin_thickness_mm();
  skin_options.smooth = job.options.smooth;
  auto shared_skin =
      skins.get(skin_options.thickness_mm, [&] { return build_skin(prepared.solid, skin_options, context); });
  if (!shared_skin) return shared_skin.error();
  const std::shared_ptr<const Skin> skin = std::move(shared_skin).value();
  skin_volume_mm3 = skin->volume_mm3;
  report.thin = skin->thin;
  if (skin->smoothing) report_smoothing(*skin->smoothing, &report);
  laps.lap("skin");
  if (skin->is_thin_everywhere()) {
    auto made = make_solid(prepared, *skin, request, job.options, out_dir / printer.id, &report, context);
    if (!made) return made.error();
    laps.lap("write");
    return report;
  }

  const FrameOptions asked = frame_options(request, job);
  const std::string key = sampling_key(*skin, asked, context) + rule_key(printer);
  std::optional<InitialFrame> earlier;
  if (job.warm_start) {
    report.warm_start = WarmStartReport{job.warm_start->job_id, {}, {}};
    earlier = find_earlier_frame(*job.warm_start, printer.id, key, *skin, asked, &*report.warm_start);
  }
  auto sampled =
      earlier ? sample_again(*earlier, &report)
              : sample_or_go_on(
                    fmt::format("sample/{}/{}", printer.id, key),
                    [&] { return sample_by_stress(prepared, *skin, request, job, laps, &report, context); },
                    &report, observer.checkpoints);
  if (!sampled) return sampled.error();

  const BalanceState balance = decide_balance(job.options.balance, prepared.contact);
  if (balance == BalanceState::kEnforced && prepared.contact.hull.size() < 3) {
    report.reason = Reason::kInfeasible;
    report.detail = "balance cannot hold: the base contact has no area; see --up and --balance";
    return report;
  }
  auto posed =
      pose_problem(prepared.solid, prepared.contact, *skin, *sampled, request, job.loads, job.options);
  if (!posed) return posed.error();
  report.warnings.insert(report.warnings.end(), posed->warnings.begin(), posed->warnings.end());
  if (balance == BalanceState::kNotStanding)
    report.warnings.push_back(
        fmt::format("the solid does not stand on its lowest plane: its centre of gravity is {:.1f} mm "
                    "outside the base contact, so "
                    "balance is not enforced (see --up and --balance)",
                    -prepared.contact.margin_mm));

  SolveSetting setting{prepared,         *skin, printer,      job.options,
                       balance,          laps,  std::nullopt, observer.checkpoints,
                       sampled->openings};
  if (earlier && earlier->reduced && !job.options.no_optimize) {
    SampledFrame reduced = *sampled;
    reduced.frame = earlier->reduced->frame;
    auto again =
        pose_problem(prepared.solid, prepared.contact, *skin, reduced, request, job.loads, job.options);
    if (again) {
      setting.start.emplace(ReducedStart{*earlier, std::move(again.value().problem)});
    } else {
      report.warm_start->detail = "its reduced frame does not fit: " + again.error().message;
    }
  }
  FrameProblem problem = posed->problem;
  auto merged = solve_and_merge(setting, &problem, &report, context);
  if (!merged) return merged.error();
  if (report.supports && !report.supports->state.holds())
    report.warnings.push_back(
        fmt::format("while printing some strut or support gives way by {:.3g} mm along the vertical, more "
                    "than the limit of "
                    "{:.3g} mm",
                    report.supports->state.worst_deformation_mm, *report.supports->state.limit_mm));
  if (report.warm_start && !report.warm_start->detail.empty())
    report.warnings.push_back(
        fmt::format("warm start from job {}: {}", report.warm_start->job_id, report.warm_start->detail));

  const OptimizeResult& result = *report.optimised;
  report.seconds.insert(result.seconds.begin(), result.seconds.end());
  const auto folder = out_dir / printer.id;
  auto frame_json = to_json(result.problem, result.radii_mm, result.displacements_mm);
  frame_json[kStrutSizes] = strut_sizes_json(result);
  if (result.certificate) frame_json["certificate"] = certificate_json(*result.certificate);
  if (report.supports) frame_json["supports"] = supports_json(*report.supports, printer, *skin);
  if (auto written = write_json(folder / "frame.json", frame_json); !written) return written.error();
  report.files.push_back("frame.json");
  const bool optimised = report.reason == Reason::kNone && !job.options.no_optimize;
  auto initial =
      initial_frame_json(problem, *sampled, report.sampling->density, key, optimised ? &result : nullptr);
  if (auto written = write_json(folder / "initial-frame.json", initial); !written) return written.error();
  report.files.push_back("initial-frame.json");
  if (!merged.value()) return report;
  if (auto finished =
          finish_print(*merged.value(), prepared, *skin, request, job, folder, laps, &report, context);
      !finished)
    return finished.error();
  return report;
}

}  // namespace skinframe
